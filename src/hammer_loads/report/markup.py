"""Pieces of HTML. All text that comes from a database goes through text() or a function that calls it."""
import datetime
import html
import math
import unicodedata

UNITS = {"N": (1e-3, "kN"), "Nm": (1e-3, "kN m"), "MPa": (1.0, "MPa"), "Pa": (1e-6, "MPa"), "m": (1e3, "mm")}


def text(value):
    """Escaped; what no page may hold (control characters, half of a surrogate pair) is replaced."""
    shown = "".join("\ufffd" if unicodedata.category(c) in ("Cc", "Cs", "Cn") and c not in "\n\t" else c
                    for c in str(value))
    return html.escape(shown, quote=True)


def number(value, digits=4):
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "\u2013"
    if isinstance(value, float) and math.isinf(value):
        return "no end" if value > 0 else "-\u221e"
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f")
    shown = f"{value:.{digits}g}"
    if "e" in shown and 1e-4 <= abs(value) < 1e7:
        shown = f"{value:.0f}"
    return shown.replace("-", "\u2212") if not shown[:1].isalpha() else shown


def places_of(deviation):
    """Decimal places up to its second digit (JCGM 100, 7.2.6); below zero where that stands before the point."""
    return 1 - math.floor(math.log10(deviation))


def measured(value, deviation):
    """Value and deviation, the value to the place of the deviation's second digit."""
    if value is None or not deviation or not math.isfinite(value) or not math.isfinite(deviation):
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


def utc(stamp_ns):
    if stamp_ns is None:
        return "\u2013"
    moment = datetime.datetime(1970, 1, 1) + datetime.timedelta(microseconds=stamp_ns // 1000)
    return moment.strftime("%Y-%m-%d %H:%M:%S") + f".{stamp_ns // 1000000 % 1000:03d}"


def duration(seconds):
    if seconds is None:
        return "\u2013"
    whole = int(seconds)
    if whole < 60:
        return f"{seconds:.1f} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"


def moment(stamp_ns, to="seconds"):
    """UTC; page.js writes the reader's local time beside it. Bytes of a page depend on no time zone."""
    if stamp_ns is None:
        return "\u2013"
    shown = utc(stamp_ns)[:19 if to == "seconds" else 16]
    return Raw(f'<time datetime="{utc(stamp_ns)[:19].replace(" ", "T")}Z" data-to="{to}">{shown}</time>')


class Raw(str):
    """Is HTML already."""


def cell(value):
    if isinstance(value, Raw):
        return value
    return text(value if isinstance(value, str) else number(value))


def table(caption, header, rows, numbers=True, kind=None):
    """First column: what the row is about. kind: classes of the table, else by `numbers`."""
    head = "".join(f'<th scope="col">{cell(name)}</th>' for name in header)
    body = "".join(f'<tr><th scope="row">{cell(row[0])}</th>' + "".join(f"<td>{cell(v)}</td>" for v in row[1:]) + "</tr>\n"
                   for row in rows)
    kind = kind or ("numbers" if numbers else "words")
    return (f'<div class="scroll" tabindex="0" role="region" aria-label="{text(caption)}">\n'
            f'<table class="{kind}"><caption>{text(caption)}</caption>\n<thead><tr>{head}</tr></thead>\n'
            f"<tbody>\n{body}</tbody></table></div>\n")


def block(title, content):
    """What stays together on paper."""
    return Raw(f'<div class="block"><h4>{text(title)}</h4>\n{content}</div>\n')


def details(summary, content):
    return f"<details><summary>{text(summary)}</summary>\n{content}</details>\n"


def paragraph(words, kind=None):
    return f"<p{f' class={kind}' if kind else ''}>{text(words)}</p>\n"


def section(name, title, content, level=2):
    return f'<section id="{name}" aria-labelledby="{name}-title">\n<h{level} id="{name}-title">{text(title)}</h{level}>\n{content}</section>\n'
