"""Tables of the documents."""


def table(head, rows):
    """Markdown, one string for each cell; the first column are names."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def below(difference, bound):
    """The bound, a power of ten, which a difference by rounding has to keep: the same text on every computer."""
    if not difference < bound:
        raise ValueError(f"difference: {difference:g}, must be below {bound:g}")
    return f"below {bound:.0e}"


def beside(value, right):
    """A value with its relative error, where that is seen."""
    error = value / right - 1.0
    return f"{value:.1f} ({error:+.0%})" if abs(error) >= 0.005 else f"{value:.1f}"
