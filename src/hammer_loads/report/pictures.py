"""Pictures by matplotlib: SVG within the page, in the colours of its style, so that they follow the screen's theme."""
from collections import namedtuple
import io
import logging
import re

from markupsafe import Markup, escape

from report.formats import clean

logging.getLogger("matplotlib").setLevel(logging.ERROR)  # no messages about fonts and caches
import matplotlib  # noqa: E402  (its first import logs)
import numpy  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402
from matplotlib.colors import to_rgba  # noqa: E402
from matplotlib.figure import Figure as Sheet  # noqa: E402
from matplotlib.ticker import MaxNLocator, ScalarFormatter  # noqa: E402

WIDTH, HEIGHT = 460, 270
LEFT, RIGHT, TOP, BOTTOM = 58, 10, 12, 42
# Names of page.css.
COLOURS = {"ink": "#1b2430", "soft": "#5b6675", "rule": "#d3d9e0", "first": "#1f5fa8", "second": "#b4530f", "third": "#2d7a3a",
           "fourth": "#8a4b9c", "fifth": "#a31621", "sixth": "#7a7010", "seventh": "#1f8287", "eighth": "#6a5fd0"}
MOST_BANDS = 3  # one over the other

# keys: (class of the line or box, words).
Figure = namedtuple("Figure", "svg caption keys")

matplotlib.rcdefaults()  # not those of the user: the same file gives the same page
matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "hammer_loads", "font.size": 11, "axes.grid": True, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": COLOURS["rule"], "axes.labelcolor": COLOURS["soft"],
    "grid.color": COLOURS["rule"], "xtick.color": COLOURS["ink"], "ytick.color": COLOURS["ink"], "xtick.major.size": 0,
    "ytick.major.size": 0, "xtick.major.pad": 6, "xtick.labelsize": 11, "ytick.labelsize": 11, "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-4, 6), "lines.linewidth": 1.6, "lines.solid_joinstyle": "round"})


def plain(text):
    """Text without control characters, which matplotlib does not parse as a formula."""
    return clean(text).replace("$", r"\$").replace("\n", " ")


# One sheet for all pictures: creating axes and ticks takes half of the time of a picture.
SHEET = Sheet(figsize=(WIDTH / 72.0, HEIGHT / 72.0))
AXES = SHEET.add_axes([LEFT / WIDTH, BOTTOM / HEIGHT, 1.0 - (LEFT + RIGHT) / WIDTH, 1.0 - (TOP + BOTTOM) / HEIGHT])
AXES.yaxis.set_label_coords(-0.115, 0.5)


class Picture:
    """The axes, empty and with titles; what is drawn has the classes of page.css. One at a time."""

    def __init__(self, x_title, y_title):
        self.axes = AXES
        for drawn in [*AXES.lines, *AXES.collections, *AXES.patches]:
            drawn.remove()
        AXES.set_yscale("linear")
        for axis in (AXES.xaxis, AXES.yaxis):
            axis.set_major_locator(MaxNLocator(6))
            axis.set_major_formatter(ScalarFormatter())
        AXES.relim()
        AXES.autoscale(True)
        AXES.margins(x=0.0, y=0.05)
        AXES.set_xlabel(plain(x_title))
        AXES.set_ylabel(plain(y_title))

    def line(self, x, y, name, **style):
        """Line that is interrupted where there is no number."""
        self.axes.plot(x, y, color=COLOURS[name], gid=f"line {name}", **style)

    def band(self, x, low, high, name, alpha=0.22):
        self.axes.fill_between(x, low, high, facecolor=COLOURS[name], alpha=alpha, linewidth=0.0, gid=f"band {name}")

    def curve(self, points, name, among=1):
        """Line of the means, band from least to greatest, of many curves its edges; a point alone is a dot with a bar."""
        x, low, middle, high = (points[key].to_numpy() for key in ("x", "least", "middle", "greatest"))
        known = numpy.concatenate([[False], numpy.isfinite(middle), [False]])
        alone = known[1:-1] & ~known[:-2] & ~known[2:]
        if among <= MOST_BANDS:
            self.band(x, low, high, name)
        else:
            self.line(numpy.r_[x, numpy.nan, x], numpy.r_[low, numpy.nan, high], name, linewidth=0.7, alpha=0.6)
        self.line(x, middle, name)
        if alone.any():
            self.line(x[alone], middle[alone], name, linestyle="", marker="o", markersize=3.0)
            self.axes.vlines(x[alone], low[alone], high[alone], color=COLOURS[name], alpha=0.4)

    def bars(self, edges, heights):
        self.axes.bar(edges[:-1], heights, numpy.diff(edges), align="edge", color=COLOURS["first"], alpha=0.75)

    def boxes(self, corners, name, strength):
        """corners: (left, right, bottom, top) of each; strength: of their colour, up to 1."""
        self.axes.add_collection(PolyCollection(
            [[(left, bottom), (right, bottom), (right, top), (left, top)] for left, right, bottom, top in corners],
            facecolors=[to_rgba(COLOURS[name], alpha) for alpha in strength], linewidths=0.0, gid=f"box {name}"))
        self.axes.autoscale_view()

    def figure(self, caption, keys=()):
        data = io.StringIO()
        SHEET.savefig(data, format="svg", transparent=True)
        return Figure(as_part_of_page(data.getvalue(), caption), caption, keys)


def as_part_of_page(svg, title):
    """SVG element without the parts of a stand-alone file. Colours become CSS variables, ids become classes."""
    svg = svg[svg.index(">", svg.index("<svg")) + 1:]
    svg = re.sub(r"<metadata>.*?</metadata>|<defs>\s*<style.*?</style>\s*</defs>", "", svg, flags=re.DOTALL)
    svg = re.sub(r' d="[^"]+"', lambda path: re.sub(r"(?<=\.\d)\d+", "", path.group()), svg)
    svg = re.sub(r"font: ([\d.]+px)[^;\"]*", r"font-size: \1", svg)
    svg = re.sub(r'<g id="[\w.]+_\d+"', "<g", svg).replace('<g id="', '<g class="')
    for name, colour in COLOURS.items():
        svg = svg.replace(colour, f"var(--{name})")
    svg = re.sub(r"\n\s*", "\n", svg)
    return Markup(f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(clean(title))}">{svg}')


def with_own_ids(page):
    """Page whose pictures have distinct ids of clip paths and markers."""
    pictures = re.split(r"(<svg.*?</svg>)", page, flags=re.DOTALL)
    for at in range(1, len(pictures), 2):
        pictures[at] = re.sub(r'( id="|href="#|url\(#)', rf"\g<1>p{at // 2}", pictures[at])
    return "".join(pictures)
