"""Quantities with a value for each revolution, and the SQL of figures of runs: for pages and for the merged file of a fleet."""
from collections import namedtuple

# expression: of the table's columns; factor: from its unit to the one shown; deviation: column of the measurement's.
Quantity = namedtuple("Quantity", "key title table expression unit factor deviation meaning")

QUANTITIES = [
    Quantity("blow_rate", "Blow rate", "turns", "1.0 / period", "Hz", 1.0, None,
             "one over the time from blow to blow"),
    Quantity("energy", "Blow energy", "blows", "energy", "J", 1.0, "energy_std",
             "lost by rocker and rod at the blow. Not the tool energy of AEM, which is measured in the tool's steel"),
    Quantity("restitution", "Restitution", "blows", "restitution", "", 1.0, "restitution_std",
             "rocker's speed after the blow over that before"),
    Quantity("amplitude", "Peak force along the tool", "turns", "amplitude", "kN", 1e-3, "amplitude_std",
             "largest force along the tool in a revolution"),
    Quantity("mean_hold_down_force", "Hold-down needed", "blows", "mean_hold_down_force", "kN", 1e-3, None,
             "mean force that keeps the hull on the tool: tool impulse times blow rate"),
]


def value_of(quantity):
    """SQL of a quantity; NULL for a blow whose energy is withheld."""
    if quantity.table != "blows":
        return quantity.expression
    return f"CASE WHEN energy IS NOT NULL THEN {quantity.expression} END"


# Means of a run: stiffness over that of the boom file, its deviation, share of turns whose damping no oil makes.
CYLINDERS = ("cylinder, count(*) AS turns, avg(stiffness_ratio) AS stiffness, avg(stiffness_ratio_std) AS deviation, "
             "avg(doubtful) AS doubtful FROM boom_cylinders WHERE {runs} GROUP BY run_id, cylinder ORDER BY cylinder")
