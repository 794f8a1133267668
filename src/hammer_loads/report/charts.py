"""Data of the charts that page.js draws with dygraphs. Each point is [least, middle, greatest]."""
import json

from report.markup import Raw, text

KEYS = "arrow keys move along the time, plus and minus zoom, 0 shows everything"


def short(value):
    return None if value is None else float(f"{value:.4g}")


def band(point):
    return None if point is None else [short(v) for v in point]


def with_breaks(points):
    rows, last = [], 0.0
    for point in points:
        last = point[0] if point else last
        rows.append([round(last, 3), band(point[1:]) if point else None])
    return rows


class Charts:
    """Of one page."""

    def __init__(self):
        self._charts = []

    def over_time(self, title, unit, points, first_ns, group):
        """`points`: (time_s after first_ns, least, middle, greatest), None for a break."""
        return self._add(title, {"unit": unit, "labels": [title], "group": group, "rows": with_breaks(points),
                                 "base_ms": (first_ns or 0) // 1000000})

    def compared(self, title, unit, labels, step, columns, group):
        """`columns`: for each label a list of points on the same grid of time, a point every `step`."""
        rows = [[round((i + 0.5) * step, 4)] + [band(column[i][1:]) if column[i] else None for column in columns]
                for i in range(len(columns[0]))]
        return self._add(title, {"unit": unit, "labels": labels, "group": group, "rows": rows})

    def of_choice(self, title, choices, first_ns):
        """`choices`: (name, unit, points); the reader takes one of them."""
        content = [{"label": f"{name} [{unit}]" if unit else name, "unit": unit, "rows": with_breaks(points)}
                   for name, unit, points in choices]
        options = "".join(f"<option>{text(name)}</option>" for name, _, _ in choices)
        label = f'<label class="choice">Channel <select data-chart="{len(self._charts)}">{options}</select></label>\n'
        return Raw(label + self._add(title, {"choices": content, "labels": [content[0]["label"]],
                                             "group": f"choice{len(self._charts)}",
                                             "base_ms": (first_ns or 0) // 1000000}))

    def _add(self, title, chart):
        chart["title"] = title
        number = len(self._charts)
        self._charts.append(chart)
        return Raw(f'<div class="legend" id="legend{number}"></div>\n<div class="chart" id="chart{number}" tabindex="0" '
                   f'role="group" aria-label="{text(title)}: {KEYS}"></div>\n')

    def as_json(self):
        """Safe within a script element."""
        plain = json.dumps(self._charts, separators=(",", ":"), ensure_ascii=True)
        return plain.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
