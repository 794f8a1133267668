#!/usr/bin/env python3
"""Writes what the fuzzer begins with: sessions and series as test/fuzz reads them, parameters from config/."""
import argparse
import math
import pathlib
import struct

KEYS = 80  # no fewer than test/fuzz/drawn_settings.h finds
COUNTS = 4096  # of the encoder per turn, as shipped


def session(choice, rate, speed, turns):
    """A crank at constant speed [rad/s], sampled at a rate [Hz]."""
    data = bytes([choice])
    samples = int(turns * 2 * math.pi / speed * rate)
    for i in range(samples):
        angle = (1.0 + speed * i / rate) % (2 * math.pi)
        data += struct.pack("<BHHh", 0, int(1e6 / rate), int(angle / (2 * math.pi) * COUNTS), round(100 * speed))
    return data


def drawn(key):
    """Settings with this number and the next ones at the least, the most and somewhere between."""
    places = [0, 65535, 40503 * (key + 1) % 65536]
    return b"".join(struct.pack("<BBBBHBH", 254, 37 * key % 256, 2, key, place, key + 1, 65535 - place)
                    + session(0, 200, 30, 1)[1:] for place in places)


def pipeline_seeds():
    boom = struct.pack("<Bd", 6, -0.35)
    raw = struct.pack("<BId", 5, 1000000, 1.0)
    stamped = struct.pack("<BQdd", 4, 1700000001000000000, 2.0, 30.0)
    shapes = struct.pack("<BBBBBff", 7, 1, 1, 1, 0, 3.0, 30.0)
    whole = {f"settings_{key:02d}": session(1, 200, 30, 2) + drawn(key) + session(1, 200, 30, 2)[1:] for key in range(KEYS)}
    return {
        **whole,
        "rocker_1khz": session(1, 1000, 120, 3),
        "linkage_200hz": session(2, 200, 30, 4),
        "pulse_100hz": session(16, 100, 25, 3),
        "rocker_50hz": session(209, 50, 20, 3),
        "all_operations": session(1, 100, 30, 2) + boom + raw + stamped + shapes + b"\xff" + session(1, 100, 30, 1)[1:],
    }


def parameter_seeds(config):
    text = {path.stem: path.read_bytes() for path in sorted(config.glob("*.yaml"))}
    whole = b"\n".join(text[name] for name in ("hammer_mo100", "pipeline", "log", "life"))
    lines = (line for line in whole.split(b"\n") if not line.lstrip().startswith(b"#"))
    bare = b"\n".join(line.split(b" #")[0].rstrip() for line in lines)
    return {**text, "whole": whole, "whole_bare": bare}


def cycles_seeds():
    value = lambda number: struct.pack("<Bd", 0, number)
    noise = bytes([30]) + b"".join(bytes([4, i * 37 % 256]) for i in range(100))
    plateaus = bytes([200]) + b"".join(struct.pack("<Bh", 1 + 8 * 5, i * 331 % 1999 - 999) for i in range(40))
    special = bytes([0]) + b"".join(map(value, (math.nan, 1.0, math.inf, -2.0, -math.inf, 1e308, -1e300, 5e-324, -0.0)))
    return {
        "noise": noise,
        "plateaus": plateaus,
        "special": special,
        "cuts_and_gaps": noise + bytes([2, 3]) + plateaus[1:] + bytes([2]) + special[1:],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=pathlib.Path)
    arguments = parser.parse_args()
    config = pathlib.Path(__file__).resolve().parent.parent / "config"
    all_seeds = {"pipeline": pipeline_seeds(), "parameter": parameter_seeds(config), "cycles": cycles_seeds()}
    for kind, seeds in all_seeds.items():
        (arguments.directory / kind).mkdir(parents=True, exist_ok=True)
        for name, data in seeds.items():
            (arguments.directory / kind / name).write_bytes(data)


if __name__ == "__main__":
    main()
