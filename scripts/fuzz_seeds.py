#!/usr/bin/env python3
"""Writes what the fuzzer begins with: sessions as test/fuzz/pipeline_fuzz.cpp reads them, parameters from config/."""
import argparse
import math
import pathlib
import struct

COUNTS = 4096  # of the encoder per turn, as shipped


def session(choice, rate, speed, turns):
    """A crank at constant speed [rad/s], sampled at a rate [Hz]."""
    data = bytes([choice])
    samples = int(turns * 2 * math.pi / speed * rate)
    for i in range(samples):
        angle = (1.0 + speed * i / rate) % (2 * math.pi)
        data += struct.pack("<BHHh", 0, int(1e6 / rate), int(angle / (2 * math.pi) * COUNTS), round(100 * speed))
    return data


def pipeline_seeds():
    boom = struct.pack("<Bd", 6, -0.35)
    raw = struct.pack("<BId", 5, 1000000, 1.0)
    stamped = struct.pack("<BQdd", 4, 1700000001000000000, 2.0, 30.0)
    shapes = struct.pack("<BBBBBff", 7, 1, 1, 1, 0, 3.0, 30.0)
    return {
        "rocker_1khz": session(1, 1000, 120, 3),
        "linkage_200hz": session(2, 200, 30, 4),
        "pulse_100hz": session(16, 100, 25, 3),
        "difference_100hz": session(225, 100, 25, 3),
        "none_50hz": session(209, 50, 20, 3),
        "all_operations": session(1, 100, 30, 2) + boom + raw + stamped + shapes + b"\xff" + session(1, 100, 30, 1)[1:],
    }


def parameter_seeds(config):
    text = {path.stem: path.read_bytes() for path in sorted(config.glob("*.yaml"))}
    whole = b"\n".join(text[name] for name in ("hammer_mo100", "pipeline", "log"))
    lines = (line for line in whole.split(b"\n") if not line.lstrip().startswith(b"#"))
    bare = b"\n".join(line.split(b" #")[0].rstrip() for line in lines)
    return {**text, "whole": whole, "whole_bare": bare}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=pathlib.Path)
    arguments = parser.parse_args()
    config = pathlib.Path(__file__).resolve().parent.parent / "config"
    for kind, seeds in (("pipeline", pipeline_seeds()), ("parameter", parameter_seeds(config))):
        (arguments.directory / kind).mkdir(parents=True, exist_ok=True)
        for name, data in seeds.items():
            (arguments.directory / kind / name).write_bytes(data)


if __name__ == "__main__":
    main()
