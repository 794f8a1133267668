"""Pictures as SVG: colours come from the page's style, so that they follow the screen's theme and the printer."""
import math

from report.markup import number, text

WIDTH, HEIGHT = 460, 300
LEFT, RIGHT, TOP, BOTTOM = 58, 12, 14, 44


def ticks(low, high, most=6):
    """Round numbers within [low, high]."""
    if not high > low:
        return [low]
    rough = (high - low) / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(s * power for s in (1, 2, 2.5, 5, 10) if s * power >= rough * (1 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [i * step for i in range(first, last + 1)]


def coordinate(value):
    return f"{value:.1f}".rstrip("0").rstrip(".")


class Axes:
    """Coordinates of a picture; what is drawn comes as SVG text into `parts`."""

    def __init__(self, x_range, y_range, x_title, y_title, x_labels=None, y_labels=None):
        self.x_range, self.y_range = x_range, y_range
        self.parts = []
        self._axis_x(x_title, x_labels or [(v, number(v + 0.0)) for v in ticks(*x_range)])
        self._axis_y(y_title, y_labels or [(v, number(v + 0.0)) for v in ticks(*y_range)])

    def x(self, value):
        low, high = self.x_range
        return LEFT + (value - low) / ((high - low) or 1.0) * (WIDTH - LEFT - RIGHT)

    def y(self, value):
        low, high = self.y_range
        return HEIGHT - BOTTOM - (value - low) / ((high - low) or 1.0) * (HEIGHT - TOP - BOTTOM)

    def _axis_x(self, title, labels):
        for value, label in labels:
            at = coordinate(self.x(value))
            self.parts.append(f'<path class="grid" d="M{at} {TOP}V{HEIGHT - BOTTOM}"/>'
                              f'<text x="{at}" y="{HEIGHT - BOTTOM + 15}" text-anchor="middle">{text(label)}</text>')
        self.parts.append(f'<text class="title" x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 8}" '
                          f'text-anchor="middle">{text(title)}</text>')

    def _axis_y(self, title, labels):
        for value, label in labels:
            at = self.y(value)
            self.parts.append(f'<path class="grid" d="M{LEFT} {coordinate(at)}H{WIDTH - RIGHT}"/>'
                              f'<text x="{LEFT - 5}" y="{coordinate(at + 4)}" text-anchor="end">{text(label)}</text>')
        middle = (TOP + HEIGHT - BOTTOM) / 2
        self.parts.append(f'<text class="title" transform="translate(13 {middle}) rotate(-90)" '
                          f'text-anchor="middle">{text(title)}</text>')

    def path(self, points):
        """Of (x, y); a point without a number breaks the line."""
        commands, pen = [], "M"
        for px, py in points:
            if py is None or px is None:
                pen = "M"
                continue
            commands.append(f"{pen}{coordinate(self.x(px))} {coordinate(self.y(py))}")
            pen = "L"
        return "".join(commands)

    def line(self, points, kind):
        self.parts.append(f'<path class="line {kind}" d="{self.path(points)}"/>')

    def band(self, points, kind):
        """Between the two ends of (x, low, high)."""
        known = [p for p in points if p[1] is not None and p[2] is not None]
        if known:
            outline = [(p[0], p[2]) for p in known] + [(p[0], p[1]) for p in reversed(known)]
            self.parts.append(f'<path class="band {kind}" d="{self.path(outline)}Z"/>')

    def box(self, x0, x1, y0, y1, kind, strength=None, title=None):
        left, bottom, right, top = self.x(x0), self.y(y0), self.x(x1), self.y(y1)
        opacity = f' fill-opacity="{strength:.2f}"' if strength is not None else ""
        inner = f"<title>{text(title)}</title>" if title else ""
        self.parts.append(f'<rect class="{kind}" x="{coordinate(left)}" y="{coordinate(top)}" '
                          f'width="{coordinate(right - left)}" height="{coordinate(bottom - top)}"{opacity}>{inner}</rect>')

    def drawn(self, title):
        return (f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{text(title)}">'
                + "".join(self.parts) + "</svg>")


def figure(picture, caption, legend=()):
    """`legend`: (class of the line or box, words)."""
    keys = "".join(f'<span class="key"><i class="{kind}"></i>{text(words)}</span> ' for kind, words in legend)
    return (f"<figure>{picture}<figcaption>{text(caption)}{'<br>' if keys else ''}{keys}</figcaption></figure>\n")
