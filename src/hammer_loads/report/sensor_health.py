"""Whether the crank's sensor is sound."""
from report.markup import Raw, number, paragraph, scaled, table

CONSISTENT = 3.0   # times the variance; a sound sensor has 0.9
JITTER_S = 1e-4    # from there on the wrench is some 0.2 % worse
REFUSED = 0.01     # of the samples


def refusals_of(subject):
    counts = {}
    for _, row in subject.of_runs("SELECT reason, count FROM refusals WHERE run_id = ? ORDER BY reason"):
        counts[row["reason"]] = counts.get(row["reason"], 0) + row["count"]
    return sorted(counts.items(), key=lambda item: (-item[1], item[0]))


def worst_of(subject, name):
    return max((run[name] for run in subject.runs if run[name] is not None), default=None)


def judged(value, limit):
    if value is None:
        return "not determined"
    return "sound" if value <= limit else "look at it"


def health_rows(subject):
    """(what, value, verdict, meaning)."""
    consistency, jitter = worst_of(subject, "consistency"), worst_of(subject, "timing_noise_s")
    resolution, noise = worst_of(subject, "angle_resolution_rad"), worst_of(subject, "speed_noise_rad_s")
    deviation = worst_of(subject, "drive_inertia_deviation")
    samples = subject.total("samples")
    refused = sum(count for _, count in refusals_of(subject))
    share = refused / samples if samples else None
    restarts, backward = subject.total("restarts"), subject.total("backward_passes")
    return [
        ["Consistency", number(consistency, 3), judged(consistency, CONSISTENT),
         "surprise over what the filter expects; 1 is right, beyond 3 sensor or hammer file are wrong"],
        ["Jitter of the stamps", f"{number(scaled(jitter, 1e3), 3)} ms", judged(jitter, JITTER_S),
         "beyond 0.1 ms the wrench is some 0.2 % worse"],
        ["Refused samples", f"{refused} of {samples}", judged(share, REFUSED), "by reason below"],
        ["Restarts", number(restarts), "sound" if restarts <= len(subject.runs) else "look at it",
         "drop-outs, jumps, time running back; one a run is its start"],
        ["Passages backward", number(backward), "sound" if backward <= 3 else "look at it",
         "more than a few: crank_direction has the wrong sign"],
        ["Resolution of the angle", f"{number(scaled(resolution, 1e3), 3)} mrad", "", "step between two readings"],
        ["Noise of the speed", f"{number(noise, 3)} rad/s", "", "where the speed is measured"],
        ["Drive inertia", f"{number(worst_of(subject, 'drive_inertia_kg_m2'), 3)} kg m\u00b2",
         "", f"relative deviation {number(deviation, 2)}"],
    ]


def sensor_health(subject):
    if not subject.runs:
        return paragraph("The file holds no run.")
    note = paragraph("Of several runs the worst.", "note") if len(subject.runs) > 1 else ""
    content = note + table("The crank's sensor", ["Figure", "Value", "Verdict", "Meaning"], health_rows(subject),
                           numbers=False)
    refusals = refusals_of(subject)
    if not refusals:
        return Raw(content + paragraph("No sample was refused."))
    return Raw(content + table("Refused samples by reason", ["Reason", "Samples"], [list(row) for row in refusals]))
