from html.parser import HTMLParser
from pathlib import Path

import pandas as pd
import pytest

from cogmap import CogmapError
from cogmap.experiments.result import Result
from cogmap.pages.report import report
from cogmap.plots.style import new_figure

VOID = {"meta", "link", "img", "br"}


class Page(HTMLParser):
    """The tags of a page, which must close in the order in which they opened."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.opened: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words = ""
        self.feed(text)
        assert not self.opened

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.opened.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.opened.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words += data


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    figure = new_figure(2.0, 1.0)
    figure.subplots().plot([0, 1])
    result = tmp_path / "result"
    result.mkdir()
    metrics = {"experiment": "cyclic", "arena": "<script>alert(1)</script>", "views": 9, "error_m": 0.5}
    Result(metrics, {"errors": pd.DataFrame({"a<b": [1]})}, {"walk": figure, "ring": figure}).write(result)
    return result


def test_it_is_whole_and_needs_nothing_else(folder: Path) -> None:
    text = report(folder).read_text(encoding="utf-8")
    page = Page(text)
    pictures = [attributes for tag, attributes in page.tags if tag == "img"]
    assert len(pictures) == 2
    assert all(picture["alt"] and picture["width"] == "220" for picture in pictures)
    for _, attributes in page.tags:
        for name in ("src", "href", "srcset", "action"):
            assert (attributes.get(name) or "data:").startswith("data:")
    assert "@import" not in text
    assert "url(" not in text
    assert not {tag for tag, _ in page.tags} & {"script", "iframe", "object"}
    assert "<script>alert(1)</script>" in page.words
    assert "a<b" in page.words
    assert "0.5 m" in page.words
    assert "max-width: 100%" in text
    assert "width=device-width" in text


def test_the_same_result_gives_the_same_page_elsewhere(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "deep" / "page.html"
    assert report(folder, out) == out
    assert out.read_bytes() == report(folder).read_bytes()
    assert out.read_bytes() == report(folder, out).read_bytes()
    assert [file.name for file in out.parent.iterdir()] == ["page.html"]


def test_what_is_no_report_is_left_alone(folder: Path, tmp_path: Path) -> None:
    diary = tmp_path / "diary.html"
    diary.write_text("mine", encoding="utf-8")
    for path in (diary, folder):
        with pytest.raises(CogmapError, match="exists and is not a report"):
            report(folder, path)
    with pytest.raises(CogmapError, match="cannot write"):
        report(folder, diary / "page.html")
    assert diary.read_text(encoding="utf-8") == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["diary.html", "result"]
