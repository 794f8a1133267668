"""Health of the crank's sensor."""
from report.formats import Table, number, scaled

CONSISTENT = 3.0   # times the variance; a sound sensor has 0.9
JITTER_S = 1e-4    # from there on the wrench is some 0.2 % worse
REFUSED = 0.01     # of the samples
PITCH_RAD = 1.2    # as the warning of the node
SOUND, DOUBTFUL = "sound", "look at it"


def refusals_of(subject):
    """(reason, samples), the most first."""
    rows = subject.frame("reason, count AS samples FROM refusals WHERE {runs}", text=["reason"])
    counts = rows.groupby("reason").samples.sum().astype(int)
    return sorted(counts.items(), key=lambda item: (-item[1], item[0]))


def worst_of(subject, name):
    return max((run[name] for run in subject.runs if run[name] is not None), default=None)


def worst_pitch(subject):
    known = (run["hull_pitch"] for run in subject.runs if run["hull_pitch"] is not None)
    return max(known, key=abs, default=None)


def judged_pitch(value):
    return judged(value if value is None else abs(value), PITCH_RAD)


def judged(value, limit):
    if value is None:
        return "not determined"
    return SOUND if value <= limit else DOUBTFUL


def health_rows(subject):
    """[figure, value, verdict, meaning]."""
    consistency, jitter = worst_of(subject, "consistency"), worst_of(subject, "timing_noise")
    resolution, noise = worst_of(subject, "angle_resolution"), worst_of(subject, "speed_noise")
    deviation = worst_of(subject, "drive_inertia_relative_std")
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
        ["Restarts", number(restarts), judged(restarts, len(subject.runs)),
         "drop-outs, jumps, time running back; one a run is its start"],
        ["Passages backward", number(backward), judged(backward, 3),
         "more than a few: crank_direction has the wrong sign"],
        ["Hull pitch", f"{number(worst_pitch(subject), 3)} rad", judged_pitch(worst_pitch(subject)),
         "largest at the end of a run; at work beyond 1.2 rad a sign or an offset of a boom joint is wrong"],
        ["Resolution of the angle", f"{number(scaled(resolution, 1e3), 3)} mrad", "", "step between two readings"],
        ["Noise of the speed", f"{number(noise, 3)} rad/s", "", "where the speed is measured"],
        ["Drive inertia", f"{number(worst_of(subject, 'drive_inertia'), 3)} kg m\u00b2",
         "", f"relative deviation {number(deviation, 2)}"],
    ]


def sensor_health(subject):
    return {"table": Table("The crank's sensor", ["Figure", "Value", "Verdict", "Meaning"], health_rows(subject), "words"),
            "refusals": Table("Refused samples by reason", ["Reason", "Samples"], refusals_of(subject))}
