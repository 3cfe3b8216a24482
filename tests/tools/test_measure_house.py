import ast
from textwrap import dedent

from tools.measure_house import constants, measure

FILE = '''
    """A module."""
    LONE = 1
    """What it is."""
    ONE, TWO = 1, 2
    TYPED: int = 3
    name = 4


    class Thing:
        def method(self, a, b, /, c, d, *rest, e, f, g, **more):
            """Do nothing."""
            # Because there is nothing to do.
            return (
                a
            )
'''


def test_a_file_is_counted_line_by_line() -> None:
    found = measure({"cogmap/thing.py": dedent(FILE).lstrip()})
    assert found["files"] == 1
    assert found["lines"] == 15
    assert found["lines of code"] == 9
    assert found["comments, % of lines"] == 6.7
    assert found["longest function"] == "6 cogmap/thing.py:method"
    assert found["longest file"] == "15 cogmap/thing.py"
    assert found["functions with > 8 parameters"] == 1
    assert found["folders with > 14 files"] == "none"


def test_constants_are_upper_case_at_the_level_of_the_module() -> None:
    assert constants(ast.parse(dedent(FILE))) == (1, 4)


def test_a_folder_is_crowded_past_fourteen_files() -> None:
    code = "def f(): pass\n"
    files = {f"cogmap/room/file_{index}.py": code for index in range(15)}
    assert measure(files)["folders with > 14 files"] == "cogmap/room (15)"
    files.pop("cogmap/room/file_0.py")
    assert measure({**files, "cogmap/room/__init__.py": code})["folders with > 14 files"] == "none"
