"""Numbers, times and tables as a page shows them. Templates escape all text."""
from collections import namedtuple
import datetime
import math
import numbers
import unicodedata

from markupsafe import Markup

UNITS = {"N": (1e-3, "kN"), "N m": (1e-3, "kN m"), "N s": (1.0, "N s"), "-": (1.0, ""), "MPa": (1.0, "MPa"), "Pa": (1e-6, "MPa"), "m": (1e3, "mm")}
NOTHING = "\u2013"

# The first column names the row. kind: classes of the table, `numbers` or `words`.
Table = namedtuple("Table", "caption header rows kind")
Table.__new__.__defaults__ = ("numbers",)


def clean(text):
    """Text with control characters and halves of surrogate pairs replaced."""
    return "".join("\ufffd" if unicodedata.category(c) in ("Cc", "Cs", "Cn") and c not in "\n\t" else c for c in text)


def shown(value):
    """Value of a template as text."""
    if hasattr(value, "__html__"):
        return value
    if isinstance(value, str):
        return clean(value)
    return number(value)


def is_nothing(value):
    return value is None or (isinstance(value, float) and math.isnan(value))


def number(value, digits=4):
    if is_nothing(value):
        return NOTHING
    if isinstance(value, float) and math.isinf(value):
        return "no end" if value > 0 else "-\u221e"
    if isinstance(value, numbers.Integral):
        return f"{value:,}".replace(",", "\u202f")
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-4 <= abs(value) < 1e7:
        text = f"{value:.0f}"
    return text.replace("-", "\u2212")


def places_of(deviation):
    """Decimal places up to its second digit (JCGM 100, 7.2.6); below zero where that stands before the point."""
    return 1 - math.floor(math.log10(deviation))


def measured(value, deviation):
    """Value and deviation, the value to the place of the deviation's second digit."""
    if is_nothing(value) or is_nothing(deviation) or not deviation or not math.isfinite(value + deviation):
        return number(value)
    places = places_of(deviation)
    if places <= 0:
        return f"{number(round(value))} \u00b1 {number(round(deviation))}"
    return f"{value:.{places}f} \u00b1 {deviation:.{places}f}".replace("-", "\u2212")


def in_unit(unit):
    """Factor and name under which a unit is shown."""
    return UNITS.get(unit, (1.0, unit or ""))


def scaled(value, factor):
    return None if value is None else value * factor


def titled(title, unit):
    return f"{title} [{unit}]" if unit else title


def utc(stamp_ns):
    if is_nothing(stamp_ns):
        return NOTHING
    moment_ = datetime.datetime(1970, 1, 1) + datetime.timedelta(microseconds=int(stamp_ns) // 1000)
    return moment_.strftime("%Y-%m-%d %H:%M:%S") + f".{int(stamp_ns) // 1000000 % 1000:03d}"


def duration(seconds):
    if is_nothing(seconds):
        return NOTHING
    whole = int(seconds)
    if whole < 60:
        return f"{seconds:.1f} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"


def moment(stamp_ns, to="seconds"):
    """UTC; the page's script writes the reader's local time beside it. Bytes of a page depend on no time zone."""
    if is_nothing(stamp_ns):
        return NOTHING
    whole = utc(stamp_ns)[:19]
    return Markup('<time datetime="{}Z" data-to="{}">{}</time>').format(
        whole.replace(" ", "T"), to, whole if to == "seconds" else whole[:16])
