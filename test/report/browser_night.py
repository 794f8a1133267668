"""Pages in headless Chromium: no console error, nothing wider than the window, every picture drawn; screenshots to look at.

HAMMER_LOADS_PICTURES: folder that keeps the pictures.
"""
import json
import os
import pathlib
import re
import subprocess

import pytest

from support import report_here
import sample_database as sample

# In the page: what a user would see, told to the frame around it.
PROBE = """<script>
window.addEventListener('load', function () {
  var wide = [];
  document.querySelectorAll('main *').forEach(function (e) {
    if ((!e.closest('.scroll') || e.classList.contains('compare')) && !e.closest('svg') && e.getBoundingClientRect().right > window.innerWidth + 1) wide.push(e.tagName + '.' + e.className);
  });
  var drawn = Array.from(document.querySelectorAll('svg')).filter(function (svg) {
    return svg.closest('details') || Array.from(svg.querySelectorAll('.line path, .box path, .band path, [clip-path]')).some(function (path) {
      return path.getBoundingClientRect().width > 0;
    });
  });
  parent.postMessage(JSON.stringify({
    width: window.innerWidth, scroll: document.documentElement.scrollWidth, wide: wide,
    pictures: document.querySelectorAll('svg').length, drawn: drawn.length, local: document.querySelectorAll('time .local').length
  }), '*');
});
</script>"""
FRAME = """<!DOCTYPE html><title>frame</title><body style="margin:0"><iframe src="{page}" style="border:0;width:{width}px;height:{height}px">
</iframe><script>window.addEventListener('message', function (e) {{ document.title = e.data; }});</script>"""


def chromium(folder, *arguments, width=1280, height=2400):
    done = subprocess.run(
        ["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr",
         "--force-prefers-reduced-motion", f"--user-data-dir={folder}/chromium", f"--window-size={max(500, width)},{height}",
         "--virtual-time-budget=5000", *map(str, arguments)], capture_output=True, text=True, timeout=120)
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


@pytest.fixture
def pictures(tmp_path):
    folder = pathlib.Path(os.environ.get("HAMMER_LOADS_PICTURES", tmp_path))
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@pytest.fixture
def page(tmp_path):
    def make(name, *files):
        out = tmp_path / (name + ".html")
        done = report_here(*files, "--html", out)
        assert done.returncode == 0, done.stderr
        return out
    return make


def seen(page, width, pictures):
    """Result of the probe at a window of this width, and errors."""
    probed, frame = page.with_name(page.stem + "_probed.html"), page.with_name("frame.html")
    probed.write_text(page.read_text(encoding="utf-8").replace("</body>", PROBE + "</body>"), encoding="utf-8")
    frame.write_text(FRAME.format(page=probed.name, width=width, height=2400))
    dom, errors = chromium(page.parent, "--dump-dom", frame.as_uri(), width=width)
    frame.write_text(FRAME.format(page=page.name, width=width, height=6000))
    picture = pictures / f"{page.stem}_{width}.png"
    _, more = chromium(page.parent, f"--screenshot={picture}", frame.as_uri(), width=width, height=6000)
    assert picture.stat().st_size > 30000
    found = re.search(r"<title>(\{.*?\})</title>", dom)
    assert found, f"no word from the page; console: {errors}"
    return json.loads(found.group(1).replace("&quot;", '"')), errors + more


def assert_good(page, least, pictures):
    """No error, nothing too wide, at least so many pictures, each drawn."""
    for width in (1280, 400):
        found, errors = seen(page, width, pictures)
        assert errors == []
        assert (found["width"], found["wide"]) == (width, [])
        assert found["scroll"] <= width
        assert found["drawn"] == found["pictures"] >= least
        assert found["local"] > 0


def test_an_error_would_be_seen(tmp_path):
    bad = tmp_path / "bad.html"
    bad.write_text("<!DOCTYPE html><body><p>x</p><script>throw new Error('seen')</script></body>")
    assert [line for line in chromium(tmp_path, "--dump-dom", bad.as_uri())[1] if "seen" in line]


def test_the_page_of_one_machine_is_good(made, page, pictures, tmp_path):
    written = page("machine", made("machine", seconds=300.0, boom=True, refusals={"duplicate": 3},
                                   warnings=[("jitter", "crank stamps jitter by 0.23 ms")]))
    assert_good(written, 30, pictures)
    paper = pictures / "machine.pdf"
    chromium(tmp_path, "--no-pdf-header-footer", f"--print-to-pdf={paper}", written.as_uri())
    assert paper.stat().st_size > 50000


def test_the_page_of_two_machines_is_good(made, page, pictures):
    files = [made(name, machine=sample.Machine(name, peak_N=peak), seconds=60.0, boom=True)
             for name, peak in (("first", 40000.0), ("second", 60000.0))]
    assert_good(page("two", *files), 65, pictures)


def test_hostile_names_are_escaped(made, page, pictures):
    assert_good(page("idle", made("idle", seconds=0.0, warnings=[("k", "<script>throw 1</script>" * 20)])), 0, pictures)
