"""The computed load of the hull beside a measured one."""
from report.formats import Table, in_unit, number


def reference(subject):
    """Comparison over all runs with a measured load; None where none has."""
    if "reference" not in subject.database.tables() or not subject.runs:
        return None
    rows = subject.frame("component, unit, samples, rms, rms_error, bias, scale, correlation, within_two_std FROM reference "
                         "WHERE {runs} ORDER BY component", text=["component", "unit"])
    if rows.empty:
        return None
    cells = []
    for row in rows.itertuples():
        factor, unit = in_unit(row.unit)
        cells.append([row.component, str(row.run + 1), number(int(row.samples)), f"{number(factor * row.rms)} {unit}",
                      f"{number(factor * row.rms_error, 3)} {unit}", f"{number(100.0 * row.rms_error / row.rms, 2)} %",
                      f"{number(factor * row.bias, 3)} {unit}", number(row.scale), number(row.correlation, 5),
                      f"{number(100.0 * row.within_two_std, 3)} %"])
    header = ["Component", "Run", "Samples", "Measured, rms", "Error, rms", "Error, relative", "Bias", "Scale", "Correlation",
              "Within two"]
    return Table("Computed and measured load", header, cells)
