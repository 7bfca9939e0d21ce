"""The page in a real browser: every item that it promises, driven as a user would."""

import base64
import contextlib
import itertools
import json
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from playwright.sync_api import Browser, ConsoleMessage, Error, Page, expect

import asperity
from asperity.config import Case, load
from asperity.config.case_file import builtin_text
from asperity.config.key_labels import label
from asperity.config.problems import check
from asperity.integration import COMPILATION
from asperity.results.colours import COLOURS
from asperity.results.shares import share_texts
from asperity.web.form import form
from browser import needed, served
from test_single_bodies import OPEN as SINGLE_BODIES

CASE = builtin_text("published-exact").replace('"half-space"', '"rigid"')
CASE = CASE.replace("[roughness]", '[roughness]\nplacement = "mean"')
CASE = f"{CASE}\n[numerics]\nmax_impacts = 20\n"
PATIENT = 90_000  # ms: a first answer compiles


@pytest.fixture(scope="session")
def browser_type_launch_args():
    return {"executable_path": needed(), "args": ["--no-sandbox"]}


@pytest.fixture(scope="module")
def file(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("page") / "drop.toml"
    path.write_text(CASE)
    return path


@pytest.fixture(scope="module")
def result() -> asperity.Result:
    """What the program finds for the same case."""
    return asperity.solve(load(CASE), critical=False)


@pytest.fixture(scope="module")
def address(file):
    with served(file) as found:
        yield found


class Window(NamedTuple):
    """A page, what it asked for, and what errors it logged."""

    page: Page
    asked: list[str]
    wrong: list[str]

    @classmethod
    def of(cls, browser: Browser) -> "Window":
        made = cls(browser.new_page(), [], [])

        def hear(said: ConsoleMessage) -> None:
            if said.type == "error" and "422" not in said.text:  # the browser logs every refusal
                made.wrong.append(said.text)

        made.page.set_default_timeout(PATIENT)
        made.page.on("pageerror", lambda error: made.wrong.append(str(error)))
        made.page.on("console", hear)
        made.page.on("request", lambda request: made.asked.append(request.url))
        return made

    def show(self, address: str) -> None:
        self.page.goto(address)
        self.page.wait_for_selector("#verdicts .said")
        self.page.wait_for_selector("#map canvas")


@pytest.fixture(scope="module")
def window(browser: Browser) -> Iterator[Window]:
    made = Window.of(browser)
    yield made
    made.page.close()


@pytest.fixture
def page(window: Window, address: str) -> Iterator[Page]:
    """A page that shows the case anew, and logs no error until it is left."""
    window.page.set_viewport_size({"width": 1280, "height": 720})
    window.show(address)
    yield window.page
    window.page.unroute_all(behavior="ignoreErrors")
    window.page.goto("about:blank")
    wrong = window.wrong.copy()
    window.wrong.clear()
    assert wrong == []


@pytest.fixture(scope="module")
def shared(browser: Browser, address: str) -> Iterator[Window]:
    made = Window.of(browser)
    made.show(address)
    yield made
    made.page.close()
    assert made.wrong == []


@pytest.fixture
def common(shared: Window) -> Iterator[Page]:
    """One page for all tests that only look at it; each leaves it as it found it."""
    page = shared.page
    before = look(page)
    yield page
    assert look(page) == before


def look(page: Page) -> tuple[list[dict], str, dict]:
    """Designs, colours, and the size of the window."""
    theme = page.evaluate("() => getComputedStyle(document.documentElement).colorScheme")
    return state(page), theme, page.viewport_size


def settled(page: Page) -> None:
    """Wait until what is shown is the answer to the newest question."""
    page.wait_for_function(
        "() => document.body.dataset.busy === 'no' && asperity.designs().every("
        "(one) => one.shown === one.asked && !one.running)"
    )


def write(page: Page, key: str, text: str) -> None:
    field = page.locator(f"#field-{key.replace('.', '-')}")
    field.fill(text)
    field.press("Enter")
    field.blur()


def slide(page: Page, key: str, share: float) -> None:
    page.locator(f"#field-{key.replace('.', '-')}-slider").evaluate(
        "(slider, to) => { slider.value = to; slider.dispatchEvent(new Event('input')); }",
        round(1000 * share),
    )


def add(page: Page, table: str, name: str) -> None:
    """One more table of a name of the user's own."""
    page.locator(f"#table-{table}").evaluate("(one) => { one.open = true; }")
    page.locator(f"#new-{table}").fill(name)
    page.locator(f"#new-{table} + button").click()


def drawn(page: Page, panel: str) -> int:
    """Pixels of a panel's picture that are not blank."""
    return page.locator(f"#{panel} canvas").evaluate(
        "(c) => c.getContext('2d').getImageData(0, 0, c.width, c.height)"
        ".data.reduce((sum, value, n) => sum + (n % 4 === 3 && value > 0 ? 1 : 0), 0)"
    )


def picture(page: Page, panel: str) -> str:
    return page.locator(f"#{panel} canvas").evaluate("(c) => c.toDataURL()")


def state(page: Page) -> list[dict]:
    return page.evaluate("() => JSON.parse(JSON.stringify(asperity.designs()))")


def choose(page: Page, key: str, value: str) -> None:
    """Open what hides a control and choose."""
    field = page.locator(f"#field-{key.replace('.', '-')}")
    reveal(page, f"#field-{key.replace('.', '-')}")
    field.select_option(value)


def reveal(page: Page, selector: str) -> None:
    page.locator(selector).evaluate(
        "(one) => { for (let each = one; each; each = each.parentElement) each.open = true; }"
    )


def tick(page: Page, table: str) -> None:
    reveal(page, f"#use-{table}")
    page.locator(f"#use-{table}").click()
    page.wait_for_function("() => !asperity.designs()[0].completing")


def hold(page: Page, what: str = "explore") -> list:
    """Let no question of a kind be answered from now on; those that are held."""
    held = []

    def keep(route):
        held.append(route)

    page.route(f"**/api/{what}", keep)
    return held


def shown_case(page: Page) -> str:
    """What the case box says is shown."""
    return page.locator("#case").evaluate("(box) => box.selectedOptions[0].textContent")


def opacity(page: Page, selector: str) -> float:
    return page.locator(selector).first.evaluate("(one) => Number(getComputedStyle(one).opacity)")


def test_a_case_shows_motion_forces_ledger_curve_map_verdict_and_warnings(shared, result):
    page, asked, _ = shared
    for panel in ("motion", "forces", "energy", "curve", "rebounds", "map"):
        assert drawn(page, panel) > 2000, panel
        label = page.locator(f"#{panel} [role=img]").get_attribute("aria-label")
        assert label, panel
    expect(page.locator("#verdicts .said")).to_have_text(
        "No verdict: 0.56 asperities are expected to touch at closest approach, but a single body "
        "falls until a summit carries it; the numbers are means over many bodies"
    )
    assert page.locator("#warning-list li").all_text_contents() == result.warnings
    expect(page.locator("#bars")).to_contain_text("lost to capillary")
    expect(page.locator("#bars")).to_contain_text("(100 % of the energy lost)")
    legend = page.locator("#curve .legend").inner_text().split("\n")
    assert legend == ["loading", "unloading"]
    expect(page.locator("#measures")).to_contain_text("487.9 µm/s")
    here = page.url.split("#")[0]
    assert all(one.startswith((here, "blob:", "data:")) for one in asked)


LOST = [[0.505, 0.495], [1.0, 1.0, 1.0], [0.7, 0.2996, 0.0004], [2.0, 1e-9, 0.0], [0.0]]


def test_shares_on_the_page_are_those_of_the_summary(common):
    script = "(all) => import('/static/units.js').then((m) => all.map((one) => m.shares(one)))"
    assert common.evaluate(script, LOST) == [share_texts(lost) for lost in LOST]


def test_every_key_of_the_form_has_a_field_named_in_words_with_the_key_as_a_hint(page):
    hold(page)  # nothing need be computed
    for table in form():
        if table["named"]:
            add(page, table["name"], "x")
        elif not (table["needed"] or page.locator(f"#use-{table['name']}").is_checked()):
            tick(page, table["name"])
    fields = page.locator("[id^=field-]").evaluate_all(
        "(all) => Object.fromEntries(all.map((one) => [one.id, "
        "[one.labels?.[0]?.textContent, one.parentElement.querySelector('.key')?.textContent]]))"
    )
    for table in form():
        name = table["name"]
        keys = [key["key"] for key in table["keys"]]
        if table["named"]:
            assert {f"field-{name}.x-{key}" for key in keys} <= set(fields)
            continue
        assert label(name).lower() in page.locator(f"#table-{name} > summary").inner_text().lower()
        for key in keys:
            words, hint = fields[f"field-{name}-{key}"]
            assert words.lower() == label(f"{name}.{key}").lower()
            assert words[0].isupper()
            assert f"{name}.{key}" in hint


def test_a_slider_by_mouse_or_keyboard_gives_the_numbers_of_the_program(page):
    before = picture(page, "curve")
    slide(page, "roughness.rms_height", 0.47)
    settled(page)
    assert picture(page, "curve") != before
    text = page.locator("#field-roughness-rms_height").input_value()
    assert text.endswith(" nm")
    assert float(text.split()[0]) < 10.5
    case = load(CASE).replace({"roughness.rms_height": text})
    wanted = asperity.solve(case, critical=False).measures["restitution"][0]
    shown = page.evaluate("() => asperity.designs()[0].answer.measures.restitution[0]")
    assert shown == pytest.approx(wanted, rel=1e-9)
    assert page.evaluate("() => asperity.latencies.length") >= 2
    slider = page.get_by_role("slider", name="Rms height")
    slider.focus()
    slider.press("ArrowLeft")
    settled(page)
    value = page.locator("#field-roughness-rms_height").input_value()
    assert value != text
    assert slider.get_attribute("aria-valuetext") == value


def test_materials_of_ones_own_have_fields_sliders_and_refusals(page):
    add(page, "materials", "my glass")
    field = '[id="field-materials.my%20glass-{}"]'.format
    page.locator(field("density")).fill("2700 kg/m^3")
    page.locator(field("density")).press("Enter")
    write(page, "body.material", "my glass")
    settled(page)
    glass = {"youngs_modulus": "70 GPa", "poisson": 0.22, "density": "2700 kg/m^3"}
    tables = state(page)[0]["tables"]
    assert (tables["materials"], tables["body"]["material"]) == ({"my glass": glass}, "my glass")
    before = picture(page, "curve")
    page.get_by_role("slider", name="Young's modulus of my glass").press("PageDown")
    settled(page)
    assert picture(page, "curve") != before
    page.locator(field("poisson")).fill("0.7")
    page.locator(field("poisson")).press("Enter")
    settled(page)
    wrong = page.locator('[id="field-materials.my%20glass-poisson-wrong"]')
    expect(wrong).to_contain_text("must lie in (-1, 0.5]")
    page.locator('[id="remove-materials.my%20glass"]').click()
    settled(page)
    assert "materials" not in state(page)[0]["tables"]
    expect(page.locator("#field-body-material-wrong")).to_contain_text("my glass")


def test_every_control_has_a_name_and_the_keyboard_reaches_it(page):
    page.locator("#compare").click()
    settled(page)
    nameless = page.evaluate(
        "() => [...document.querySelectorAll('input, select, button, textarea, summary')].filter("
        "(one) => !(one.labels?.length || one.getAttribute('aria-label') || "
        "one.textContent.trim())).map((one) => one.outerHTML)"
    )
    assert nameless == []
    page.locator(".skip").focus()
    reached = []
    for _ in range(14):
        reached.append(
            page.evaluate("() => document.activeElement.id || document.activeElement.className")
        )
        page.keyboard.press("Tab")
    for wanted in ("case", "own-case", "own-surface", "compare", "copy-case", "copy-link", "theme"):
        assert wanted in reached


def test_every_bad_field_is_marked_with_its_own_message_and_the_last_picture_stays(page):
    before, verdict = picture(page, "motion"), page.locator("#verdicts .said").inner_text()
    write(page, "body.radius", "-5 um")
    write(page, "capillary.humidity", "1.5")
    write(page, "adhesion.equilibrium_spacing", "")
    keys = {
        "body-radius": "`radius` must be positive",
        "capillary-humidity": "must lie in [0, 1]",
        "adhesion-equilibrium_spacing": "must be given with model = 'dmt'",
    }
    for key, words in keys.items():
        expect(page.locator(f"#field-{key}-wrong")).to_contain_text(words)
        field = page.locator(f"#field-{key}")
        assert field.get_attribute("aria-invalid") == "true"
        assert field.get_attribute("aria-describedby") == f"field-{key}-wrong"
        assert field.evaluate("(one) => getComputedStyle(one).borderTopWidth") == "2px"
    assert page.locator("#verdicts .wrong").count() == 3
    assert picture(page, "motion") == before
    assert page.locator("#verdicts .said").inner_text() == verdict
    page.locator("#verdicts .wrong button").nth(1).click()
    assert page.evaluate("() => document.activeElement.id") in [f"field-{key}" for key in keys]
    write(page, "capillary.humidity", "30 %")
    assert state(page)[0]["tables"]["capillary"]["humidity"] == 0.3
    write(page, "adhesion.equilibrium_spacing", "0.2 nm")
    settled(page)
    expect(page.locator("#field-body-radius-wrong")).to_be_visible()
    expect(page.locator("#field-capillary-humidity-wrong")).to_be_hidden()
    write(page, "body.radius", "50 um")
    settled(page)
    expect(page.locator("#field-body-radius-wrong")).to_be_hidden()
    assert page.locator("#verdicts .wrong").count() == 0
    write(page, "impact.release_separation", "30 nm")  # which only the solver finds
    expect(page.locator("#field-impact-release_separation-wrong")).to_contain_text(
        "outside contact"
    )


def test_a_body_that_leaves_after_one_impact_is_drawn(page):
    """One point alone has an axis too, and a height that does not exist no place on it."""
    page.locator("#more-impact").evaluate("(one) => { one.open = true; }")
    write(page, "impact.speed", "0.1 m/s")
    page.locator("#more-impact").evaluate("(one) => { one.open = true; }")
    write(page, "impact.gravity", "0 m/s^2")
    settled(page)
    expect(page.locator("#verdicts .said")).to_contain_text("does not come back")
    assert page.evaluate("() => asperity.designs()[0].answer.motion.impacts") == 1
    assert drawn(page, "rebounds") > 100


def test_more_impacts_than_are_drawn_are_said(common):
    expect(common.locator("#motion .drawn")).to_have_text("first 12 of 20 impacts")


def assert_within(page: Page, width: int) -> None:
    """Nothing runs off a screen of some width, on which the verdict is seen at once."""
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    for panel in ("motion", "map"):
        box = page.locator(f"#{panel} canvas").bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= width
    expect(page.locator("#verdicts")).to_be_in_viewport()


def test_two_designs_stand_side_by_side(page):
    page.locator("#compare").click()
    write(page, "capillary.humidity", "0.3")
    settled(page)
    assert page.locator("#verdicts .said").count() == 2
    heads = page.locator("#measures thead th").all_text_contents()
    assert heads == ["A: drop", "B: drop"]
    assert "B unloading" in page.locator("#curve .legend").inner_text()
    first, second = state(page)
    assert first["tables"]["capillary"]["humidity"] == 0.6
    assert second["tables"]["capillary"]["humidity"] == 0.3
    assert_within(page, 1280)
    page.get_by_label("A", exact=True).check()
    assert page.locator("#field-capillary-humidity").input_value() == "0.6"
    page.locator("#compare").click()
    assert page.locator("#verdicts .said").count() == 1


def reload(page: Page) -> None:
    """Load the page anew once its address holds what is shown."""
    page.wait_for_timeout(500)
    page.reload()
    page.wait_for_selector("#verdicts .said")


def test_a_case_of_the_program_or_ones_own_can_be_chosen_and_the_box_says_which(page, tmp_path):
    assert shown_case(page) == "drop"
    hold(page)  # another built-in case would have to be compiled
    page.locator("#case").select_option("published")
    expect(page.locator("#use-publication")).to_be_checked()
    page.unroute("**/api/explore")
    own = tmp_path / "wet-drop.toml"
    own.write_text(CASE.replace('"50 um"', '"40 um"'))
    page.locator("#own-case").set_input_files(own)
    expect(page.locator("#notice")).to_have_text("wet-drop.toml is open.")
    settled(page)
    assert shown_case(page) == "wet-drop.toml"
    own.write_text("[body\n")
    page.locator("#own-case").set_input_files(own)
    expect(page.locator("#notice")).to_contain_text("not TOML")
    assert page.locator("#field-body-radius").input_value() == "40 um"
    reload(page)
    assert shown_case(page) == "wet-drop.toml (from the link)"
    write(page, "body.radius", "39 um")
    assert shown_case(page) == "wet-drop.toml, changed (from the link)"
    reload(page)
    assert shown_case(page) == "wet-drop.toml, changed (from the link)"
    hold(page)
    page.locator("#case").select_option("published-exact")
    for radius, shown in (("49 um", "published-exact, changed"), ("50 um", "published-exact")):
        expect(page.locator("#field-body-radius")).to_have_value("50 um")
        write(page, "body.radius", radius)
        assert shown_case(page) == shown
        page.locator("#case").select_option("published-exact")  # back to it as it was


def test_what_is_copied_or_downloaded_is_what_the_program_takes(page, tmp_path):
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    write(page, "body.radius", "42 um")
    settled(page)
    case = load(CASE).replace({"body.radius": "42 um"})
    page.locator("#copy-case").click()
    text = page.locator("#text-content")
    expect(text).to_have_value(re.compile("42 um"))
    given = text.input_value()
    assert page.evaluate("() => navigator.clipboard.readText()") == given
    assert load(given) == case
    page.locator("#text-close").click()
    page.locator("#downloads summary").click()
    for name in ("motion.csv", "record.nc"):
        with page.expect_download() as begun:
            page.get_by_role("button", name=name, exact=True).click()
        begun.value.save_as(tmp_path / name)
    head = (tmp_path / "motion.csv").read_text().split("\n")[0]
    assert head.startswith("time [s],separation [m]")
    assert asperity.read(tmp_path / "record.nc").case == case


def test_a_link_holds_both_designs_as_plain_json_and_is_followed_in_the_open_page(page, address):
    page.locator("#copy-link").click()
    first = page.url
    letters = first.split("#")[1]
    text = base64.urlsafe_b64decode(letters + "=" * (-len(letters) % 4))
    assert json.loads(text)[0]["tables"] == tomllib.loads(CASE)
    write(page, "body.radius", "42 um")
    page.locator("#compare").click()
    write(page, "capillary.humidity", "0.3")
    settled(page)
    page.locator("#copy-link").click()
    link, before = page.url, state(page)
    page.goto("about:blank")
    page.goto(link)
    page.wait_for_selector("#verdicts .said")
    settled(page)
    assert state(page) == before
    assert page.locator("#field-body-radius").input_value() == "42 um"
    page.evaluate("(to) => { location.href = to; }", first)
    page.wait_for_function(
        "() => document.querySelector('#field-body-radius')?.value === '50 um'"
        " && document.querySelector('#verdicts .said')"
    )


def test_a_link_that_holds_no_whole_state_is_told(page, address):
    half = json.dumps([{"name": "x", "tables": {"materials": {"\ud800": {}}}, "surfaces": {}}])
    for wrong in ("nonsense", base64.urlsafe_b64encode(half.encode()).decode().rstrip("=")):
        page.goto("about:blank")
        page.goto(f"{address}#{wrong}")
        expect(page.locator("#notice")).to_contain_text("does not hold a whole state")
        page.wait_for_selector("#verdicts .said")


def test_a_surface_dropped_in_becomes_the_roughness_and_no_error_is_left(page, tmp_path):
    bad = tmp_path / "bad.csv"
    bad.write_text("1 2 3\n4 5 6\n7 8 9\n")
    page.locator("#own-surface").set_input_files(bad)
    expect(page.locator("#field-roughness-files-wrong")).to_contain_text("must have a unit")
    hold(page)
    heights = np.random.default_rng(1).normal(0.0, 5e-9, (64, 64))
    rows = "\n".join(" ".join(f"{value:.6e}" for value in row) for row in heights)
    page.evaluate(
        """([name, text]) => {
          const data = new DataTransfer();
          data.items.add(new File([text], name));
          document.dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true}));
        }""",
        ["wafer.csv", f"# size[um] 4 4\n# unit m\n{rows}"],
    )
    expect(page.locator("#notice")).to_have_text("wafer.csv is the surface now.")
    assert page.locator("#field-roughness-files").input_value() == "wafer.csv"
    assert page.locator("#verdicts .wrong").count() == 0
    expect(page.locator("#field-roughness-files-wrong")).to_be_hidden()
    page.unroute("**/api/explore")
    write(page, "impact.release_separation", "200 nm")
    settled(page)
    assert page.locator("#verdicts .wrong").all_text_contents() == []
    surface = page.evaluate("() => asperity.designs()[0].answer.surface")
    assert surface["files"][0]["file"] == "wafer.csv"
    assert surface["surface_rms_height"] == pytest.approx(5e-9, rel=0.05)


def test_a_stale_answer_never_overwrites_a_newer_one(page):
    held = []

    def hold(route):
        if not held:
            held.append(route)  # the first answer comes last
        else:
            route.continue_()

    page.route("**/api/explore", hold)
    write(page, "body.radius", "41 um")
    page.wait_for_timeout(800)  # more than the page's patience with a running question
    write(page, "body.radius", "43 um")
    settled(page)
    expect(page.locator("#measures")).not_to_contain_text("being sought")
    said = page.locator("#measures").inner_text()
    assert page.evaluate("() => asperity.designs()[0].tables.body.radius") == "43 um"
    with contextlib.suppress(Error):  # the page has let go of it
        held[0].continue_()
    page.wait_for_timeout(500)
    assert page.locator("#measures").inner_text() == said


def test_what_is_old_is_dimmed_while_something_new_is_computed_which_can_be_cancelled(page):
    assert opacity(page, "#verdicts .said") == opacity(page, "#motion") == 1.0
    held = hold(page)
    write(page, "body.radius", "41 um")
    expect(page.locator("#progress-text")).to_have_text("Asking the program …")
    expect(page.get_by_role("progressbar")).to_be_visible()
    for selector in ("#verdicts .said", "#warnings", "#motion", "#ledger", "#numbers"):
        assert opacity(page, selector) < 0.6, selector
    held[0].continue_()
    settled(page)
    page.wait_for_function("() => !document.body.dataset.waiting")
    assert opacity(page, "#verdicts .said") == opacity(page, "#motion") == 1.0
    before = picture(page, "motion")
    write(page, "body.radius", "43 um")
    page.get_by_role("button", name="Cancel").click()
    expect(page.locator("#work")).to_be_hidden()
    expect(page.locator("#notice")).to_contain_text("Cancelled")
    assert picture(page, "motion") == before
    page.unroute("**/api/explore")
    write(page, "body.radius", "42 um")
    settled(page)
    assert page.locator("#verdicts .wrong").count() == 0


def test_letters_stand_out_in_light_and_dark(common):
    for _ in range(2):
        colours = common.evaluate(
            "() => Object.fromEntries(['paper', 'panel', 'ink', 'quiet', 'accent', 'wrong'].map("
            "(name) => [name, getComputedStyle(document.documentElement)"
            ".getPropertyValue('--' + name).trim()]))"
        )
        for letters in ("ink", "quiet", "wrong"):
            for ground in ("paper", "panel"):
                assert contrast(colours[letters], colours[ground]) >= 4.5, (letters, ground)
        assert contrast(colours["accent"], colours["paper"]) >= 3.0
        for name, line in COLOURS.items():
            script = "(c) => import('/static/charts.js').then((m) => m.tint(c))"
            shown = common.evaluate(script, line)
            assert contrast(shown, colours["paper"]) >= 3.0, (name, shown)
        before = picture(common, "motion")
        common.locator("#theme").click()
        assert picture(common, "motion") != before


def linear(colour: str) -> np.ndarray:
    """Red, green and blue light of a colour of the page."""
    parts = np.array([int(colour[n : n + 2], 16) / 255 for n in (1, 3, 5)])
    return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)


def contrast(*colours: str) -> float:
    """Ratio of luminances, WCAG 2.2."""
    low, high = sorted(linear(one) @ [0.2126, 0.7152, 0.0722] for one in colours)
    return (high + 0.05) / (low + 0.05)


def test_warnings_stand_beside_the_verdict_and_need_no_scrolling(page, result):
    page.set_viewport_size({"width": 1400, "height": 900})
    warnings = result.warnings
    assert len(warnings) > 3
    verdict = page.locator("#verdicts .said").bounding_box()
    seen = [one for one in page.locator("#warning-list li").all() if one.is_visible()]
    assert [one.inner_text() for one in seen] == warnings[:2]
    for one in seen:
        box = one.bounding_box()
        assert box["x"] > verdict["x"] + verdict["width"]
        assert box["y"] + box["height"] < 450
    assert page.locator("#warnings").bounding_box()["y"] < verdict["y"] + verdict["height"]
    more = page.locator("#more-warnings")
    assert more.inner_text() == f"{len(warnings) - 2} more"
    more.click()
    for one in page.locator("#warning-list li").all():
        expect(one).to_be_visible()
    assert page.locator("#warnings").bounding_box()["height"] < 450  # the charts stay in sight


WAITS = {
    COMPILATION: "Compiling for the first time",
    f"{COMPILATION} of the impacts, some 5 s": (
        "Compiling for the first time with these models: the impacts, some 5 s"
    ),
    "impact 12": "Computing the motion, impact 12",
    "motion": "Computing the motion",
    "force curves": "Computing the force curves",
    "loading": "Loading the program",
}


def test_what_is_waited_for_is_said_in_words(common):
    script = "(all) => import('/static/verdict.js').then((m) => all.map((one) => m.wait(one)))"
    for said, words in zip(common.evaluate(script, list(WAITS)), WAITS.values(), strict=True):
        assert said.startswith(words)


def test_the_critical_velocity_is_waited_for_without_dimming_unless_cancelled(page):
    sought = hold(page, "critical")
    write(page, "body.radius", "41 um")
    expect(page.locator("#progress-text")).to_contain_text("Seeking the critical velocity")
    assert opacity(page, "#verdicts .said") == opacity(page, "#motion") == 1.0
    page.get_by_role("button", name="Cancel").click()
    expect(page.locator("#work")).to_be_hidden()
    expect(page.locator("#measures")).to_contain_text("not sought")
    write(page, "body.radius", "42 um")
    settled(page)
    hold(page)
    write(page, "body.radius", "43 um")
    expect(page.locator("#progress-text")).to_have_text("Asking the program …")
    page.get_by_role("button", name="Cancel").click()
    expect(page.locator("#work")).to_be_hidden()
    begun = len(sought)
    page.wait_for_timeout(1000)  # more than twice what the page waits before it seeks
    assert len(sought) == begun
    expect(page.locator("#measures")).to_contain_text("not sought")


def test_misspelt_keys_of_an_own_case_are_told_and_can_be_taken_out(page, tmp_path):
    own = tmp_path / "typo.toml"
    text = CASE.replace("[body]", "[body]\nraduis = 3\ncolour = 'red'") + "\n[bodi]\nx = 1\n"
    own.write_text(text)
    page.locator("#own-case").set_input_files(own)
    wrong = page.locator("#table-body > .wrong")
    expect(wrong).to_contain_text("did you mean 'radius'?")
    expect(wrong).to_contain_text("colour")
    expect(page.locator("#form > .wrong")).to_contain_text("did you mean 'body'?")
    page.locator("#form .wrong button").first.wait_for()
    held = hold(page, "complete")
    page.locator("#form .wrong button").first.click()
    expect(page.locator("body")).to_have_attribute("data-busy", "yes")
    held[0].continue_()
    page.unroute("**/api/complete")
    settled(page)
    for _ in range(2):
        page.locator("#form .wrong button").first.click()
        settled(page)
    expect(page.locator("#verdicts .wrong")).to_have_count(0)
    expect(page.locator("#form .wrong:visible")).to_have_count(0)


def test_what_a_choice_fills_in_is_said_and_goes_with_it(page):
    hold(page)
    before = state(page)[0]["tables"]
    tick(page, "gas")
    for key, value in (("name", "air"), ("pressure", "101.325 kPa"), ("temperature", "20 degC")):
        expect(page.locator(f"#field-gas-{key}")).to_have_value(value)
    check(Case, state(page)[0]["tables"])
    tick(page, "gas")
    assert state(page)[0]["tables"] == before
    choose(page, "capillary.model", "kelvin-filling")
    expect(page.locator("#notice")).to_contain_text("Filled in as well: rms height of the surface")
    check(Case, state(page)[0]["tables"])
    page.locator("#case").select_option("drop")
    drop = "() => asperity.designs()[0].tables.capillary.model === 'equilibrium'"
    page.wait_for_function(drop)
    write(page, "impact.release_separation", "")
    reveal(page, "#field-impact-speed")
    write(page, "impact.speed", "10 mm/s")
    before = state(page)[0]["tables"]
    tick(page, "gas")  # which needs a gap from which the film counts
    assert state(page)[0]["tables"]["impact"]["release_separation"]
    expect(page.locator("#notice")).to_contain_text("gap at release")
    tick(page, "gas")
    assert state(page)[0]["tables"] == before


def test_a_table_that_is_taken_away_comes_back_as_it_was(page):
    hold(page)
    write(page, "roughness.rms_height", "7 nm")
    before = state(page)[0]["tables"]
    tick(page, "roughness")
    assert "roughness" not in state(page)[0]["tables"]
    tick(page, "roughness")
    assert state(page)[0]["tables"] == before


def test_what_rules_forbid_is_explained_at_the_control_with_what_mends_it(page):
    tick(page, "viscoelasticity")  # on a rigid bulk
    box = page.locator("#table-viscoelasticity > .wrong")
    expect(box).to_contain_text("Does not go with deformation of the bulk")
    expect(page.locator("#field-counterface-deformation-wrong")).to_contain_text("half-space")
    hold(page)
    box.get_by_role("button", name="Set deformation of the bulk to half-space").click()
    expect(page.locator("#field-counterface-deformation")).to_have_value("half-space")
    expect(box).to_be_hidden()
    expect(page.locator("#verdicts .wrong")).to_have_count(0)
    check(Case, state(page)[0]["tables"])


def test_keys_of_measured_surfaces_wait_for_one(common):
    field = common.locator("#field-roughness-source")
    expect(field).to_be_disabled()
    expect(field.locator("xpath=..")).to_contain_text("only with files")


def test_a_surface_that_a_case_asks_for_leaves_the_other_one(page, tmp_path):
    """Of a case of two files, each may be dropped by itself."""
    rough = 'files = ["one.csv", "two.csv"]'
    text = re.sub(r"asperity_density.*\nasperity_radius.*\nrms_height.*\n", rough + "\n", CASE)
    own, one = tmp_path / "two.toml", tmp_path / "one.csv"
    own.write_text(text)
    rows = "1 2 1 3\n2 1 4 2\n" * 2
    one.write_text(f"# size[um] 1 1\n# unit nm\n{rows}")
    page.locator("#own-case").set_input_files(own)
    expect(page.locator("#field-roughness-files-wrong")).to_contain_text("one.csv")
    page.locator("#own-surface").set_input_files(one)
    wrong = page.locator("#field-roughness-files-wrong")
    expect(wrong).to_contain_text("two.csv", timeout=PATIENT)  # once the first is read
    assert page.locator("#field-roughness-files").input_value() == "one.csv, two.csv"


def test_the_skip_button_leaves_the_state_in_the_address(common):
    common.locator("#copy-link").click()
    before = common.url
    common.locator("#skip").focus()
    common.keyboard.press("Enter")
    assert common.evaluate("() => document.activeElement.id") == "answer"
    assert common.url == before


def test_on_a_telephone_the_answer_stands_above_the_form(page):
    page.set_viewport_size({"width": 390, "height": 844})
    page.locator("#compare").click()
    settled(page)
    page.evaluate("() => scrollTo(0, 0)")
    assert_within(page, 390)
    page.locator("#compare").click()
    page.evaluate("() => scrollTo(0, 0)")
    tops = {one: page.locator(one).bounding_box()["y"] for one in ("#motion", "#measures", "#form")}
    assert tops["#motion"] < tops["#measures"] < tops["#form"]
    assert page.locator("#warnings").bounding_box()["y"] < tops["#motion"]
    page.locator("#to-form").click()
    expect(page.locator("#form")).to_be_in_viewport()
    expect(page.locator("#verdicts .said")).to_be_in_viewport()
    expect(page.locator("#to-form")).to_have_text("Back to the answer")
    page.locator("#to-form").click()
    expect(page.locator("#motion")).to_be_in_viewport()
    reveal(page, "#more-capillary")
    hold(page)
    tick(page, "gas")
    assert page.evaluate("() => document.documentElement.scrollWidth") <= 390
    smallest = page.evaluate(
        "() => Math.min(...[...document.querySelectorAll('body *')].filter((one) =>"
        " one.offsetParent && one.textContent.trim()).map("
        "(one) => parseFloat(getComputedStyle(one).fontSize)))"
    )
    assert smallest >= 11.0


# Machado, Oliveira and Fernandes, IEEE Trans. Vis. Comput. Graph. 15 (2009) 1291: severity 1.
SIGHTS = {
    "usual": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}  # fmt: skip


def lab(colour: str, sight: str) -> np.ndarray:
    """A colour as somebody sees it, in CIE L*a*b* (1976) at D65."""
    to_xyz = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
              [0.0193339, 0.1191920, 0.9503041]]  # fmt: skip
    xyz = np.array(to_xyz) @ np.clip(np.array(SIGHTS[sight]) @ linear(colour), 0.0, 1.0)
    x, y, z = np.cbrt(np.maximum(xyz / [0.95047, 1.0, 1.08883], 0.008856))
    return np.array([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


def test_kinetic_and_potential_energy_differ_for_every_eye(common):
    """Two blues are 25 apart; 2.3 is just seen, and 30 is another colour."""
    pairs = [[COLOURS["kinetic"], COLOURS["potential"]]]
    for _ in range(2):
        script = "(c) => import('/static/charts.js').then((m) => c.map(m.tint))"
        pairs.append(common.evaluate(script, pairs[0]))
        common.locator("#theme").click()
    for (one, other), sight in itertools.product(pairs, SIGHTS):
        assert np.linalg.norm(lab(one, sight) - lab(other, sight)) > 30.0, (one, other, sight)


def test_single_bodies_have_their_share_against_speed(page, tmp_path):
    """Charts that others do not have, beside a mean of few; the share falls with the speed."""
    for name in ("#capture", "#restitution"):
        expect(page.locator(name)).to_be_hidden()
    expect(page.locator("#measures")).not_to_contain_text("single bodies")
    own = tmp_path / "bodies.toml"
    own.write_text(SINGLE_BODIES)
    page.locator("#own-case").set_input_files(own)
    expect(page.locator("#verdicts")).to_contain_text("Of single bodies", timeout=PATIENT)
    settled(page)
    expect(page.locator("#capture canvas")).to_be_visible()
    drawn = page.evaluate("() => asperity.designs()[0].answer.capture")
    share, low, high = (np.array(drawn[name]) for name in ("share", "low", "high"))
    assert drawn["bodies"] == 256
    assert share[0] == 1.0
    assert share[-1] == 0.0
    assert np.all(low <= share)
    assert np.all(share <= high)
    label = page.locator("#capture .plot").get_attribute("aria-label")
    assert label.startswith("captured share [–] against speed [mm/s].")
    low, high = drawn["half_interval"]
    half = drawn["half_velocity"]
    assert drawn["speed"][4] < low < half < high < drawn["speed"][6]
    half, low, high = (f"{1e3 * speed:.4g} mm/s" for speed in (half, low, high))
    words = f"{half} (95 % interval: {low} to {high}; 256 bodies at each speed)"
    assert words in label
    expect(page.locator("#measures")).to_contain_text(words)
    expect(page.locator("#restitution canvas")).to_be_visible()
    lowest, median, highest = (np.array(drawn[name]) for name in ("lowest", "median", "highest"))
    np.testing.assert_array_equal(median == 0.0, share >= 0.5)
    np.testing.assert_array_equal(lowest == 0.0, share >= 0.1)
    assert np.all(lowest <= median)
    assert np.all(median <= highest)
