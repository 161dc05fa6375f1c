"""The explorer in a real browser: Playwright with the Chromium of the system. Without them these tests are skipped."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from conftest import STUDIES

import quell
from quell.explore import _link

sync_api = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed")
pytest.importorskip("panel", reason="Panel is not installed")

BROWSER = os.environ.get("QUELL_BROWSER") or shutil.which("chromium") or shutil.which("chromium-browser")
if BROWSER is None:
    pytest.skip("no Chromium is installed: apt-get install chromium", allow_module_level=True)

LIMIT = 30.0
"""Time in seconds within which the page has to react, on a busy machine."""

TOOLS = """() => {
  // Elements of Panel are in shadow roots.
  window.found = (name, root = document) => {
    for (const one of root.querySelectorAll('*')) {
      if (one.classList && one.classList.contains(name)) return one;
      if (one.shadowRoot) { const inner = window.found(name, one.shadowRoot); if (inner) return inner; }
    }
    return null;
  };
  window.words = (one) => {
    let all = '';
    for (const child of (one.shadowRoot || one).childNodes) {
      if (child.nodeType === 3) all += child.data;
      else if (child.nodeType === 1 && child.tagName !== 'STYLE') all += window.words(child);
    }
    return all;
  };
}"""


WATCH = """() => {
  window.seen = [];
  const look = () => {
    const one = window.found('quell-exact');
    window.seen.push([window.words(one), Number(getComputedStyle(one).opacity), performance.now()]);
    if (window.seen.length < 400) setTimeout(look, 20);
  };
  look();
}"""
"""Records the words and the opacity of the exact verdict."""


def shown(answer: Any) -> str:
    """What the page shows of an answer in a line: its sentence and its notes, between which are only line breaks."""
    return "".join([answer.sentence, *answer.notes])


class Page:
    """A page of the explorer."""

    def __init__(self, page: Any, explorer: Any) -> None:
        self.page, self.explorer = page, explorer
        self.errors: list[str] = []
        self.requests: list[str] = []
        page.on("console", lambda it: self.errors.append(it.text) if it.type == "error" else None)
        page.on("pageerror", lambda it: self.errors.append(str(it)))
        page.on("request", lambda it: self.requests.append(it.url))
        page.goto(explorer.url)
        page.wait_for_selector(".quell-motion", timeout=1e3 * LIMIT)
        page.evaluate(TOOLS)

    def words(self, name: str) -> str:
        found: str = self.page.evaluate("(name) => { const one = window.found(name); return one ? window.words(one) : ''; }", name)
        return found

    def opacity(self, name: str) -> str:
        found: str = self.page.evaluate("(name) => getComputedStyle(window.found(name)).opacity", name)
        return found

    def wait(self, name: str, holds: Callable[[str], bool]) -> str:
        """Waits until the words of an element hold."""
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            found = self.words(name)
            if holds(found):
                return found
            time.sleep(0.05)
        raise AssertionError(f"{name}: {self.words(name)!r}")

    def until(self, holds: Callable[[], bool]) -> None:
        """Waits until something holds."""
        end = time.monotonic() + LIMIT
        while not holds():
            assert time.monotonic() < end
            time.sleep(0.05)

    def type(self, path: str, value: float) -> None:
        """Types a number."""
        field = self.page.locator(f".quell-{path}-field input").first
        field.fill(str(value))
        field.press("Enter")

    def shown(self, path: str) -> float:
        """The number that a field shows."""
        return float(self.page.locator(f".quell-{path}-field input").first.input_value())

    def click(self, name: str, across: float, up: float) -> None:
        """Clicks into a picture, at fractions of its width and height."""
        canvas = self.page.locator(f".{name} .bk-Canvas").first
        canvas.scroll_into_view_if_needed()
        box = canvas.bounding_box()
        self.page.mouse.click(box["x"] + across * box["width"], box["y"] + up * box["height"])

    def undone(self, path: str, value: float) -> bool:
        """Undoes steps until a number has a value."""
        if self.explorer.study.settings[path] != value:
            self.page.locator(".quell-undo button").click()
            time.sleep(0.3)
        return bool(self.explorer.study.settings[path] == value)

    def settled(self) -> None:
        """Waits until every answer of a belt is there."""
        for name in ("motion", "spectrum", "law", "plane", "basins"):
            self.wait(f"quell-{name}-status", lambda it: " ms" in it or " s" in it)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with sync_api.sync_playwright() as playwright:
        arguments = ["--no-sandbox", "--disable-gpu", "--disable-background-networking"]
        started = playwright.chromium.launch(executable_path=BROWSER, args=arguments)
        yield started
        started.close()


@pytest.fixture(scope="module")
def belt_page(browser: Any) -> Iterator[Page]:
    explorer = quell.explore(STUDIES / "stribeck-belt.toml")
    page = Page(browser.new_page(viewport={"width": 1280, "height": 720}), explorer)
    page.settled()
    yield page
    page.page.close()
    explorer.stop()


def test_the_page_shows_every_answer_and_fetches_nothing_from_elsewhere(belt_page: Page) -> None:
    study = belt_page.explorer.study
    assert belt_page.words("quell-averaged").startswith(study.stability().sentence)
    assert belt_page.words("quell-exact") == shown(study.response())
    base = belt_page.explorer.url.split("/", 3)[:3]
    allowed = ("/".join(base), "ws" + "/".join(base)[4:], "data:", "blob:")
    assert all(it.startswith(allowed) for it in belt_page.requests), belt_page.requests


def test_a_slider_changes_the_answers(belt_page: Page) -> None:
    before = {name: belt_page.words(name) for name in ("quell-averaged", "quell-exact")}
    belt_page.page.locator(".quell-belt-belt_velocity .noUi-handle").first.press("ArrowRight")
    for name, old in before.items():
        belt_page.wait(name, lambda it, old=old: it != old)  # type: ignore[misc]
    belt_page.until(lambda: belt_page.explorer.study.settings["belt.belt_velocity"] > 0.05)
    study = belt_page.explorer.study
    belt_page.wait("quell-averaged", lambda it: it.startswith(study.stability().sentence))
    belt_page.wait("quell-exact", lambda it: it == shown(study.response()))


def test_an_invalid_number_is_refused_in_words_and_undo_works(belt_page: Page) -> None:
    kept = belt_page.words("quell-averaged")
    belt_page.type("belt-normal_load", -3)
    belt_page.wait("quell-complaints", lambda it: "normal_load" in it and "last valid numbers" in it)
    assert belt_page.words("quell-averaged") == kept and belt_page.explorer.study.settings["belt.normal_load"] == 1
    belt_page.until(lambda: float(belt_page.opacity("quell-averaged")) < 0.5)
    # A number beyond the end of the slider moves its ends.
    belt_page.type("belt-normal_load", 25)
    belt_page.until(lambda: belt_page.explorer.study.settings["belt.normal_load"] == 25)
    # The slider has its new ends before the answer is there; an earlier press would move the old one.
    belt_page.until(lambda: float(belt_page.opacity("quell-averaged")) == 1.0)
    belt_page.page.locator(".quell-belt-normal_load .noUi-handle").first.press("ArrowRight")
    belt_page.until(lambda: 25 < belt_page.explorer.study.settings["belt.normal_load"] < 27)
    # The field follows the slider, and would write over what is typed before it did.
    belt_page.until(lambda: 25 < belt_page.shown("belt-normal_load") < 27)
    belt_page.type("belt-normal_load", 2.5)
    belt_page.wait("quell-complaints", lambda it: it == "")
    belt_page.until(lambda: belt_page.explorer.study.settings["belt.normal_load"] == 2.5)
    belt_page.until(lambda: float(belt_page.opacity("quell-averaged")) == 1.0)
    belt_page.until(lambda: belt_page.undone("belt.normal_load", 1))
    belt_page.wait("quell-averaged", lambda it: it == kept)


def test_clicks_choose_a_start_and_a_point_of_the_map(belt_page: Page) -> None:
    belt_page.click("quell-phase", 0.7, 0.3)
    belt_page.wait("quell-motion-words", lambda it: it.startswith("From x = "))
    belt_page.page.locator(".quell-restart button").click()
    belt_page.wait("quell-motion-words", lambda it: it.startswith("From rest"))
    before = belt_page.explorer.study.settings["dither.amplitude"]
    belt_page.click("quell-plane-picture", 0.4, 0.15)
    belt_page.until(lambda: belt_page.explorer.study.settings["dither.amplitude"] > before)
    study = belt_page.explorer.study
    assert 0.03 < study.settings["belt.belt_velocity"] < 0.07
    belt_page.wait("quell-averaged", lambda it: it.startswith(study.stability().sentence))
    belt_page.wait("quell-share", lambda it: f"amplitude = {study.settings['dither.amplitude']}" in it)


def test_the_sound_is_played_and_compared(belt_page: Page) -> None:
    belt_page.page.locator(".quell-listen button").click()
    belt_page.wait("quell-players", lambda it: "same gain" in it and "without dither" in it)
    source = belt_page.page.evaluate("() => window.found('quell-players').shadowRoot.querySelectorAll('audio').length")
    assert source == 2


def test_the_study_is_downloaded(belt_page: Page) -> None:
    with belt_page.page.expect_download(timeout=1e3 * LIMIT) as waiting:
        belt_page.page.locator(".quell-download a, .quell-download button").first.click()
    assert waiting.value.path().read_text().startswith("<svg")


def test_what_is_stale_is_dimmed_at_once_and_gives_way(belt_page: Page) -> None:
    belt_page.settled()
    belt_page.wait("quell-exact", lambda it: it == shown(belt_page.explorer.study.response()))
    old = belt_page.words("quell-exact")
    # Under noise the exact response takes seconds: nothing of the sine stays above it.
    belt_page.page.evaluate(WATCH)
    belt_page.page.locator("select").filter(has=belt_page.page.locator("option[value=noise]")).first.select_option("noise")
    belt_page.wait("quell-exact", lambda it: "computing" in it)
    seen = belt_page.page.evaluate("() => window.seen")
    bright = [it for it in seen if it[0] == old and it[1] >= 0.5]
    # The first look may be before the page knows of the change.
    assert not bright or bright[-1][2] - seen[0][2] < 400.0, bright
    belt_page.wait("quell-exact", lambda it: "runs" in it)
    study = belt_page.explorer.study
    assert study.settings["dither.waveform"] == "noise" and belt_page.words("quell-exact") == shown(study.response())
    belt_page.wait("quell-spectrum-status", lambda it: "exact" in it and " s" in it)
    assert "KeyError" not in belt_page.words("quell-spectrum-status")
    belt_page.until(lambda: float(belt_page.opacity("quell-exact")) == 1.0)
    belt_page.page.locator(".quell-undo button").click()
    belt_page.wait("quell-exact", lambda it: it == old)
    belt_page.wait("quell-basins-status", lambda it: "exact" in it)
    for name in ("quell-phase", "quell-plane-picture", "quell-basins-picture"):
        belt_page.until(lambda name=name: float(belt_page.opacity(name)) == 1.0)  # type: ignore[misc]


def test_two_studies_are_compared_by_key(belt_page: Page) -> None:
    before = belt_page.explorer.study.settings["dither.amplitude"]
    radio = belt_page.page.locator(".quell-slot input").first
    radio.focus()
    belt_page.page.keyboard.press("ArrowRight")
    belt_page.until(lambda: belt_page.explorer._state.slot == "B")
    belt_page.type("dither-amplitude", 0.9)
    belt_page.until(lambda: belt_page.explorer.study.settings["dither.amplitude"] == 0.9)
    for key, value in (("ArrowLeft", before), ("ArrowRight", 0.9), ("ArrowLeft", before)):
        belt_page.page.locator(".quell-slot input:checked").first.focus()
        belt_page.page.keyboard.press(key)
        belt_page.until(lambda value=value: belt_page.explorer.study.settings["dither.amplitude"] == value)  # type: ignore[misc]
    belt_page.wait("quell-averaged", lambda it: it.startswith(belt_page.explorer.study.stability().sentence))


def test_a_run_is_played_and_a_picture_fills_the_screen(belt_page: Page) -> None:
    buttons = belt_page.page.locator(".quell-play button")
    assert buttons.count() > 3
    belt_page.page.locator(".quell-play input[type=range]").first.focus()
    belt_page.page.keyboard.press("ArrowRight")
    moments = "() => Bokeh.documents[0]._all_models && [...Bokeh.documents[0]._all_models.values()]"
    fullscreen = belt_page.page.evaluate(f"({moments})().filter((it) => it.type === 'FullscreenTool').length")
    assert fullscreen >= 6
    moment = f"({moments})().filter((it) => it.type === 'ColumnDataSource' && it.data.time && it.data.time.length === 1 && Number.isFinite(it.data.time[0])).length"
    belt_page.until(lambda: belt_page.page.evaluate(moment) >= 1)
    for name in ("quell-motion", "quell-basins-picture"):
        belt_page.page.locator(f".{name} [title=Fullscreen]").first.click()
        drawn = belt_page.page.locator(f".{name} .bk-Canvas canvas").first
        belt_page.until(lambda drawn=drawn: drawn.bounding_box()["width"] > 1000)  # type: ignore[misc]
        belt_page.page.evaluate("() => document.exitFullscreen()")
        belt_page.until(lambda drawn=drawn: drawn.bounding_box()["width"] < 500)  # type: ignore[misc]


def test_a_link_opens_the_state(belt_page: Page, browser: Any) -> None:
    belt_page.type("dither-amplitude", 0.37)
    belt_page.until(lambda: belt_page.explorer.study.settings["dither.amplitude"] == 0.37)
    belt_page.page.locator(".quell-share").get_by_text("link", exact=True).first.click()

    def address(text: str) -> str:
        return next(line for line in text.splitlines() if line.startswith("http"))

    def has_it(text: str) -> bool:
        return "?state=" in text and _link.decoded(_link.in_link(address(text)))[0].settings["dither.amplitude"] == 0.37

    link = address(belt_page.wait("quell-link", has_it))
    belt_page.type("dither-amplitude", 0.6)
    belt_page.until(lambda: belt_page.explorer.study.settings["dither.amplitude"] == 0.6)
    other = browser.new_page(viewport={"width": 1280, "height": 720})
    other.goto(link)
    other.wait_for_selector(".quell-motion", timeout=1e3 * LIMIT)
    belt_page.until(lambda: belt_page.explorer.study.settings["dither.amplitude"] == 0.37)
    other.close()


def test_discs_and_systems_are_shown_and_nothing_fails(belt_page: Page) -> None:
    zoo = belt_page.page.locator(".quell-zoo select").first
    zoo.select_option("figure-5.3.toml")
    belt_page.wait("quell-averaged", lambda it: "the disc is unstable" in it)
    belt_page.wait("quell-plane-status", lambda it: "Stability map" in it and (" ms" in it or " s" in it))
    zoo.select_option("two-mass-drive.toml")
    belt_page.wait("quell-averaged", lambda it: it.startswith(quell.Study.from_toml(STUDIES / "two-mass-drive.toml").stability().sentence))
    belt_page.wait("quell-eigen-status", lambda it: " ms" in it or " s" in it)
    assert belt_page.explorer.study == quell.Study.from_toml(STUDIES / "two-mass-drive.toml")
    if hasattr(quell.Study, "sketch"):
        belt_page.until(lambda: bool(belt_page.page.evaluate("() => window.found('quell-sketch').shadowRoot.querySelector('svg') !== null")))
    belt_page.page.locator(".quell-undo button").click()
    belt_page.wait("quell-averaged", lambda it: "the disc is unstable" in it)
    # A page that is loaded again begins with the same study.
    belt_page.page.reload()
    belt_page.page.wait_for_selector(".quell-motion", timeout=1e3 * LIMIT)
    belt_page.page.evaluate(TOOLS)
    belt_page.wait("quell-averaged", lambda it: "the disc is unstable" in it)
    assert [it for it in belt_page.errors if "favicon" not in it and "404" not in it] == []


def test_a_slider_and_its_effect_are_seen_together_on_a_phone(belt_page: Page) -> None:
    belt_page.page.set_viewport_size({"width": 480, "height": 800})
    zoo = belt_page.page.locator(".quell-zoo select").first
    zoo.select_option("two-mass-drive.toml")
    belt_page.wait("quell-averaged", lambda it: it.startswith(quell.Study.from_toml(STUDIES / "two-mass-drive.toml").stability().sentence))
    zoo.select_option("stribeck-belt.toml")
    belt_page.wait("quell-averaged", lambda it: it.startswith(quell.Study.from_toml(STUDIES / "stribeck-belt.toml").stability().sentence))
    handle = belt_page.page.locator(".quell-dither-amplitude .noUi-handle").first
    handle.scroll_into_view_if_needed()
    # The page is scrolled until the picture begins below the numbers, which stay.
    below = "() => window.scrollBy(0, window.found('quell-motion').getBoundingClientRect().top - 290)"
    belt_page.page.evaluate(below)
    slider, picture = handle.bounding_box(), belt_page.page.locator(".quell-motion .bk-Canvas").first.bounding_box()
    assert 0 <= slider["y"] and slider["y"] + slider["height"] <= picture["y"] + 1
    assert picture["y"] + picture["height"] <= 800
    box = belt_page.page.locator(".quell-side").first.bounding_box()
    assert slider["y"] + slider["height"] <= box["y"] + box["height"] <= picture["y"] + 1
    assert box["width"] == 480


@pytest.mark.parametrize("width", [480, 1280, 1920])
def test_no_pane_is_wider_than_the_window(belt_page: Page, width: int) -> None:
    belt_page.page.set_viewport_size({"width": width, "height": 720})
    belt_page.until(lambda: bool(belt_page.page.evaluate("() => document.documentElement.scrollWidth <= window.innerWidth")))
