"""Numbers, times and names as a page shows them."""
import datetime
import math
import numbers
import re
import unicodedata

from markupsafe import Markup

UNITS = {"N": (1e-3, "kN"), "N m": (1e-3, "kN m"), "-": (1.0, ""), "Pa": (1e-6, "MPa"), "m": (1e3, "mm")}
NOTHING = "\u2013"


def clean(text):
    """Text with control characters and halves of surrogate pairs replaced."""
    return "".join("\ufffd" if unicodedata.category(c) in ("Cc", "Cs", "Cn") and c not in "\n\t" else c for c in text)


def shown(value):
    """Value of a template as text."""
    if hasattr(value, "__html__"):
        return value
    return clean(value) if isinstance(value, str) else number(value)


def is_nothing(value):
    return value is None or (isinstance(value, float) and math.isnan(value))


def number(value, digits=4):
    if is_nothing(value):
        return NOTHING
    if isinstance(value, float) and math.isinf(value):
        return "no end" if value > 0 else "-\u221e"
    text = f"{value:,}" if isinstance(value, numbers.Integral) else f"{value:.{digits}g}"
    if "e" in text and 1e-4 <= abs(value) < 1e7:
        text = f"{value:.0f}"
    return text.replace(",", "\u202f").replace("-", "\u2212")


def rounded(value, deviation):
    """Value and deviation, both to the place of the deviation's second digit (JCGM 100, 7.2.6)."""
    if is_nothing(value) or is_nothing(deviation) or not deviation > 0.0 or not math.isfinite(value + deviation):
        return number(value), number(deviation)
    places = 1 - math.floor(math.log10(deviation))  # below zero where the digit stands before the point
    if places <= 0:
        return tuple(number(int(round(x, places))) for x in (value, deviation))
    return tuple(f"{x:.{places}f}".replace("-", "\u2212") for x in (value, deviation))


def measured(value, deviation, factor=1.0):
    """Value \u00b1 deviation, or the value alone; both times the factor."""
    value, deviation = rounded(scaled(value, factor), scaled(deviation, factor))
    return value if deviation in (NOTHING, "0") else f"{value} \u00b1 {deviation}"


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
    at = datetime.datetime(1970, 1, 1) + datetime.timedelta(microseconds=int(stamp_ns) // 1000)
    return at.isoformat(" ", "milliseconds")


def moment(stamp_ns, to="seconds"):
    """UTC; the page's script writes the reader's local time beside it. Bytes of a page depend on no time zone."""
    if is_nothing(stamp_ns):
        return NOTHING
    whole = utc(stamp_ns)[:19]
    return Markup('<time datetime="{}Z" data-to="{}">{}</time>').format(
        whole.replace(" ", "T"), to, whole if to == "seconds" else whole[:16])


def duration(seconds):
    if is_nothing(seconds):
        return NOTHING
    whole = int(seconds)
    if whole < 60:
        return f"{seconds:.1f} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"


WORDS = {
    "pulse/amplitude": "peak force along the tool",
    "pulse/impulse": "impulse of the pulse",
    "pulse/turn_impulse_x": "impulse of a revolution across the tool",
    "pulse/turn_impulse_z": "impulse of a revolution along the tool",
    "blow/energy": "blow energy",
    "blow/restitution": "restitution",
    "hull_wrench/force_x": "force across the tool, Fx",
    "hull_wrench/force_z": "force along the tool, Fz",
    "hull_wrench/torque_y": "moment about the rocker pivot, My",
}
TOPICS = {"joint_loads": "", "section_loads": "section ", "stress": "stress at "}


def in_words(quantity):
    """Words for a channel (topic/field, topic/name/field, stress/NAME) or a figure of the budget."""
    if band := re.fullmatch(r"(.*)_below_([0-9.e+-]+)Hz", quantity):
        return f"{in_words(band[1])}, below {band[2]} Hz"
    if slope := re.fullmatch(r"equivalent_range_(\d+)/(.*)", quantity):
        return f"damage-equivalent range (slope {slope[1]}) of {in_words(slope[2])}"
    topic, _, rest = quantity.partition("/")
    if quantity in WORDS or topic not in TOPICS:
        return WORDS.get(quantity, quantity)
    name, _, field = rest.partition("/")
    return TOPICS[topic] + name + (", " + field.replace("_", " ") if field else "")
