"""Pages in headless Chromium: no console error, nothing wider than the window, every picture drawn; screenshots to look at.

HAMMER_LOADS_PICTURES: folder that keeps the pictures.
"""
import json
import os
import pathlib
import re
import subprocess
import unittest

from support import ReportTest, report
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
         "--virtual-time-budget=5000", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        universal_newlines=True, timeout=120)
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


class Browser(ReportTest):
    def setUp(self):
        super().setUp()
        self.pictures = pathlib.Path(os.environ.get("HAMMER_LOADS_PICTURES", self.directory))
        self.pictures.mkdir(parents=True, exist_ok=True)

    def page(self, name, *files):
        out = self.directory / (name + ".html")
        outcome = report(*files, "--html", out)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        return out

    def seen(self, page, width):
        """Result of the probe at a window of this width, and the picture."""
        probed = page.with_name(page.stem + "_probed.html")
        probed.write_text(page.read_text(encoding="utf-8").replace("</body>", PROBE + "</body>"), encoding="utf-8")
        frame = page.with_name("frame.html")
        frame.write_text(FRAME.format(page=probed.name, width=width, height=2400))
        dom, errors = chromium(self.directory, "--dump-dom", frame.as_uri(), width=width)
        frame.write_text(FRAME.format(page=page.name, width=width, height=6000))
        picture = self.pictures / f"{page.stem}_{width}.png"
        _, more = chromium(self.directory, f"--screenshot={picture}", frame.as_uri(), width=width, height=6000)
        self.assertGreater(picture.stat().st_size, 30000)
        found = re.search(r"<title>(\{.*?\})</title>", dom)
        self.assertTrue(found, f"no word from the page; console: {errors}")
        return json.loads(found.group(1).replace("&quot;", '"')), errors + more

    def assertGood(self, page, pictures):
        for width in (1280, 400):
            seen, errors = self.seen(page, width)
            self.assertEqual(errors, [])
            self.assertEqual(seen["width"], width)
            self.assertLessEqual(seen["scroll"], width, seen["wide"])
            self.assertEqual(seen["wide"], [])
            self.assertGreaterEqual(seen["pictures"], pictures)
            self.assertEqual(seen["drawn"], seen["pictures"])
            self.assertGreater(seen["local"], 0)

    def test_an_error_would_be_seen(self):
        page = self.directory / "bad.html"
        page.write_text("<!DOCTYPE html><body><p>x</p><script>throw new Error('seen')</script></body>")
        _, errors = chromium(self.directory, "--dump-dom", page.as_uri())
        self.assertTrue([line for line in errors if "seen" in line])

    def test_the_page_of_one_machine_is_good(self):
        file = self.directory / "machine.sqlite"
        sample.make(file, seconds=300.0, warnings=[("jitter", "crank stamps jitter by 0.23 ms")], refusals={"duplicate": 3})
        page = self.page("machine", file)
        self.assertGood(page, 30)
        paper = self.pictures / "machine.pdf"
        chromium(self.directory, "--no-pdf-header-footer", f"--print-to-pdf={paper}", page.as_uri())
        self.assertGreater(paper.stat().st_size, 50000)

    def test_the_page_of_two_machines_is_good(self):
        files = []
        for name, peak in (("first", 40000.0), ("second", 60000.0)):
            files.append(self.directory / (name + ".sqlite"))
            sample.make(files[-1], sample.Machine(name, peak_N=peak), seconds=60.0)
        self.assertGood(self.page("two", *files), 65)

    def test_hostile_names_are_escaped(self):
        file = self.directory / "idle.sqlite"
        sample.make(file, seconds=0.0, boom=False, warnings=[("k", "<script>throw 1</script>" * 20)])
        self.assertGood(self.page("idle", file), 0)


if __name__ == "__main__":
    unittest.main()
