"""Which figures a warning makes doubtful, by the warning's key."""

CRANK = "crank"    # everything that comes from the crank's estimate
BOOM = "boom"      # joints, cylinders, sections, stresses
COUNTS = "counts"  # how much was seen at all
SENSOR = "sensor"  # the warning is about the sensor's own figures
ALL = {CRANK, BOOM}

# A key that is not here puts everything measured in doubt.
CONCERNS = {
    "pitch joints": {CRANK, BOOM}, "imu": {CRANK, BOOM}, "joint states": {CRANK, BOOM},
    "boom stiffness": {BOOM}, "pressures": {BOOM}, "pressure stamps": {BOOM}, "pressure fit": {BOOM}, "rock": {BOOM},
    "boom joints": {BOOM},
    "cylinder stiffness": set(), "boom damping": set(),  # found, and allowed for
    "lost messages": {COUNTS}, "publishers": ALL | {COUNTS}, "definitions": {COUNTS}, "ledger": set(),
}


def doubts_of(subject, only=None):
    """{kind: first warning that concerns it}, most important first; `only`: of this run."""
    found = {}
    for run, row in subject.of_runs("SELECT key, text FROM warnings WHERE run_id = ? ORDER BY place"):
        if only is not None and run["run_id"] != only["run_id"]:
            continue
        for kind in CONCERNS.get(row["key"], ALL):
            found.setdefault(kind, row["text"])
    return found


def kind_of(channel):
    return CRANK if channel.startswith("hull_wrench/") else BOOM
