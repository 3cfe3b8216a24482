from benchmarks.page import as_page, number

VERSUS = {
    "peer": "a snail",
    "per_s": 12345.6,
    "peer_per_s": 12.34,
    "ratio": 1000.4,
    "ratio_median": 3.0,
    "ratio_lowest": 0.0123,
    "ratio_highest": 4.5,
}
GROWTH = {"sizes": [1, 1000], "seconds": [0.5, 50.0], "exponent": 0.667, "exponent_error": 0.014}
FIGURES = {
    "machine": {"processor": "Abacus", "cores": 2, "python": "3.11.7", "numpy": "2.1"},
    "growing": {"eating_by_leaves": GROWTH, "load_before": 2.0, "load_after": 1.0},
    "running": {
        "uphill": {"fast": {**VERSUS, "stages_seconds": {"start": 0.25}}},
        "downhill": {"peer": "a stone", "not_measured": "it fell"},
        "falls": 3,
        "why": "",
        "load_before": 0.26,
        "load_after": 1.04,
    },
}
SECTIONS = """
## Running

Run.

And fall.

Load: 0.3 before, 1.0 after.

| what | beside | ours a second | its | ratio | median | lowest | highest |
| --- | --- | --- | --- | --- | --- | --- | --- |
| uphill fast | a snail | 12,346 | 12.3 | 1,000 | 3 | 0.0123 | 4.5 |
| downhill | a stone |  |  | it fell |  |  |  |

| figure | value |
| --- | --- |
| uphill fast stages seconds start | 0.25 |
| falls | 3 |

## Growing

Grow.

Load: 2.0 before, 1.0 after.

![Log–log plots of seconds against sizes](drawn.png)

| what | by | seconds | exponent | between the two largest |
| --- | --- | --- | --- | --- |
| eating | 1 to 1,000 leaves | 0.5 to 50 | 0.67 ± 0.01 | 0.67 |
"""


def test_page_has_the_machine_and_a_section_for_each_subject_in_the_order_told() -> None:
    said = {"running": "Run.\n\nAnd fall.", "sleeping": "Sleep.", "growing": "Grow."}
    head, sections = as_page(FIGURES, said, "drawn.png").split("\n## ", 1)
    assert "Abacus, 2 cores; Python 3.11.7, numpy 2.1.\n" in head
    assert "\n## " + sections == SECTIONS


def test_numbers_have_three_digits_or_all_of_a_thousand() -> None:
    told = {0.01234: "0.0123", 999.4: "999", 1000: "1,000", 1234567.8: "1,234,568", "text": "text"}
    assert {value: number(value) for value in told} == told
