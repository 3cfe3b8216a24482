"""Check the built site: links within it, nothing fetched from elsewhere, and what a user would search for.

`python docs/check_site.py docs/_build/html`; `make docs` runs it. Exits with 1 and says what is wrong.
"""

from __future__ import annotations

import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import snowballstemmer

WORDS = (
    "gridness",
    "homology",
    "odometry",
    "rayleigh",
    "deeplabcut",
    "nwb",
    "seed",
    "pillar",
    "psnr",
    "dask",
    "mirror",
)
"""What is looked for among what exists."""
FETCHED = {
    "script": "src",
    "img": "src",
    "link": "href",
    "iframe": "src",
    "video": "src",
    "source": "src",
    "audio": "src",
}


class Page(HTMLParser):
    """Targets, links and what a browser fetches, of one page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.targets: set[str] = set()
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Gather what a tag names."""
        told = {name: value for name, value in attrs if value}
        self.targets |= {told[name] for name in ("id", "name") if name in told}
        if tag == "a" and "href" in told:
            self.links.append(told["href"])
        fetched = FETCHED.get(tag)
        if fetched in told and not (
            tag == "link" and told.get("rel") in {"canonical", "next", "prev", "index", "search"}
        ):
            self.fetched.append(told[fetched])


def main(site: Path) -> int:
    """Say all that is wrong, and how much was looked at."""
    pages = {
        page: Page(page.read_text(encoding="utf-8"))
        for page in sorted(site.rglob("*.html"))
        if page.parent.name != "_static"
    }
    wrong = [*dead_links(site, pages), *fetched_from_elsewhere(site, pages), *not_found(site)]
    for line in wrong:
        print(line, file=sys.stderr)
    links = sum(len(page.links) for page in pages.values())
    print(f"{len(pages)} pages, {links} links, {len(WORDS)} words looked for: {len(wrong)} wrong")
    return bool(wrong)


def dead_links(site: Path, pages: dict[Path, Page]) -> list[str]:
    """Links within the site to what is not there."""
    dead = []
    for path, page in pages.items():
        for link in [*page.links, *page.fetched]:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            there = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            there = there / "index.html" if there.is_dir() else there
            known = pages.get(there)
            if not there.exists() or (
                known and parts.fragment and unquote(parts.fragment) not in known.targets
            ):
                dead.append(f"{path.relative_to(site)}: {link} leads nowhere")
    return dead


def fetched_from_elsewhere(site: Path, pages: dict[Path, Page]) -> list[str]:
    """Say what a browser would ask the network for, of pages and of styles."""
    asked = [
        f"{path.relative_to(site)}: {what} is fetched from elsewhere"
        for path, page in pages.items()
        for what in page.fetched
        if urlsplit(what).netloc
    ]
    for style in site.rglob("*.css"):
        found = re.findall(
            r"(?:url\(|@import)\s*[\"']?((?:https?:)?//[^\"')\s]+)", style.read_text(encoding="utf-8")
        )
        asked += [f"{style.relative_to(site)}: {what} is fetched from elsewhere" for what in found]
    return asked


def not_found(site: Path) -> list[str]:
    """Say which words a search would not find; it looks for stems, as the script of the site does."""
    text = (site / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text.removeprefix("Search.setIndex(").removesuffix(")"))
    stem = snowballstemmer.stemmer("english").stemWord
    known = {*index["terms"], *index["titleterms"]}
    return [f"a search finds no {word}" for word in WORDS if stem(word) not in known]


if __name__ == "__main__":
    raise SystemExit(main(Path(sys.argv[1]).resolve()))
