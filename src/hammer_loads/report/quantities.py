"""What is shown over time, a value for each turn."""
from collections import namedtuple

# expression: of the table's columns; factor: from its unit to the one shown.
Quantity = namedtuple("Quantity", "key title table expression unit factor meaning")

QUANTITIES = [
    Quantity("blow_rate_Hz", "Blow rate", "turns", "1.0 / period_s", "Hz", 1.0, "one over the time from blow to blow"),
    Quantity("energy_J", "Blow energy", "blows", "energy_J", "J", 1.0, "given to the tool by a blow"),
    Quantity("restitution", "Restitution", "blows", "restitution", "", 1.0,
             "rocker's speed after the blow over that before"),
    Quantity("amplitude_N", "Peak force", "turns", "amplitude_N", "kN", 1e-3, "largest force along the tool in a turn"),
    Quantity("mean_press_force_N", "Hold-down needed", "blows", "mean_press_force_N", "kN", 1e-3,
             "mean force that keeps the hull on the tool: tool impulse times blow rate"),
]
