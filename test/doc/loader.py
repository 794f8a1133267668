"""The machine of doc/your_machine.md at work: its driver's messages and the true load of its hammer on the hull.

Rigid links, a blow that is an instant. The motion is by the energy of the crank's shaft, from angle to angle; loads are by
the links' momentum, differentiated over the crank angle. No code of the package has a part in it.
"""
import math

import numpy as np

START = 1800000000.0  # [s] header stamp of the first instant
STANDS = 1.0  # [s] at rest before it works
RATE = 1000.0  # [Hz] of the crank's messages
ARM_RATE = 50.0  # [Hz]
GRAVITY = 9.80665  # [m/s2]
STEPS = 2000  # angles of a turn

# What the hammer is. The page's file has it from the drawing; it guesses the drive's inertia alone.
CRANK, ROD, ROCKER, PIVOT = 0.060, 0.175, 0.140, 0.095  # [m]
ROCKER_MASS, ROCKER_COM, ROCKER_ANGLE, ROCKER_INERTIA = 55.0, 0.125, np.radians(62.0), 1.35
CRANK_MASS, CRANK_COM, CRANK_INERTIA = 9.0, 0.012 + 0.0j, 0.035
ROD_MASS, ROD_COM, ROD_INERTIA = 6.5, 0.082 - 0.003j, 0.021
DRIVE_INERTIA = 1.1  # [kg m2]

# Its encoder: against the turn, 37 deg at the blow, a shaft that is not quite in its middle.
COUNTS, ZERO, DIRECTION = 4096, np.radians(37.0), -1
ECCENTRICITY, ECCENTRICITY_PHASE = 0.003, 0.7  # [rad]
STAMP_NOISE = 1.5e-5  # [s]

# Its motor: oil in a line that gives, behind a relief valve.
SUPPLY, SPRING, RELIEF, RELIEF_SLOPE = 28.0, 22.0, 330.0, 3.0  # [rad/s], [N m/rad], [N m], [N m s/rad]
FRICTION = 20.0  # [N m]
RESTITUTION = (0.05, 0.3)  # of the blows, drawn between them


class Links:
    """First moment, angular momentum about D and height of the links for crank angles in (0, 2 pi), per crank speed."""

    def __init__(self, angle):
        self.angle = angle
        crank_pin = CRANK * np.exp(1j * angle)
        across = PIVOT - crank_pin  # from B to D
        reach = abs(across)
        # At B in the triangle B-C-D, on the rod's working side.
        inner = np.arccos(np.clip((ROD**2 + reach**2 - ROCKER**2) / (2 * ROD * reach), -1.0, 1.0))
        joint = crank_pin + ROD * across / reach * np.exp(1j * inner)  # C
        rod, rocker = np.unwrap(np.angle(joint - crank_pin)), np.unwrap(np.angle(joint - PIVOT))
        self.rocker = rocker
        parts = [(CRANK_MASS, CRANK_INERTIA, CRANK_COM * np.exp(1j * angle) - PIVOT, angle),
                 (ROD_MASS, ROD_INERTIA, crank_pin + ROD_COM * np.exp(1j * rod) - PIVOT, rod),
                 (ROCKER_MASS, ROCKER_INERTIA - ROCKER_MASS * ROCKER_COM**2,
                  ROCKER_COM * np.exp(1j * (rocker + ROCKER_ANGLE)), rocker)]

        def along(values):
            return np.gradient(values, angle, edge_order=2)
        self.moment = sum(mass * place for mass, _, place, _ in parts)
        self.momentum = along(self.moment)
        self.angular = sum(mass * (place.conj() * along(place)).imag + inertia * along(turn)
                           for mass, inertia, place, turn in parts)
        self.inertia = DRIVE_INERTIA + sum(mass * abs(along(place))**2 + inertia * along(turn)**2
                                           for mass, inertia, place, turn in parts)
        self.slope, self.momentum_slope, self.angular_slope = map(along, (self.inertia, self.momentum, self.angular))


def in_hull(vector):
    """(x, z) in hammer_hull of a vector in the mechanism's axes; the map mirrors."""
    turned = vector * np.exp(-1j * ROCKER_ANGLE)
    return -turned.real, turned.imag


def arm(time):
    """Angles of lift (about -y) and tilt (about +y) [rad]; the hull's pitch is 0.4 - lift + tilt."""
    return 0.9 + 0.06 * np.sin(2 * np.pi * time / 17.0), 0.75 + 0.05 * np.sin(2 * np.pi * time / 11.0 + 1.0)


def pitch_of(time):
    lift, tilt = arm(time)
    return 0.4 - lift + tilt


class Work:
    """Instants of a session with crank angle since the start [rad, over the turns], speed, acceleration."""

    def __init__(self, duration, seed):
        draws = np.random.default_rng(seed)
        step = 2 * np.pi / STEPS
        self.links = Links((np.arange(STEPS) + 0.5) * step)
        inertia, weight = self.links.inertia, self.weights(STANDS)
        after = inertia[0]
        striking = np.gradient(self.links.rocker, step)
        gain, loss = striking[0], -striking[-1]
        others = after - ROCKER_INERTIA * gain**2  # what the crank's shaft turns but the rocker
        time, energy, place = STANDS, 0.5 * inertia[STEPS // 4], STEPS // 4
        turn, torque = 0, 200.0
        states = []  # instant, angle, speed, acceleration
        self.blows = []  # instant [s], energy given to tool and rock [J]

        def note(instant, angle):
            speed = (2.0 * energy / inertia[place])**0.5
            net = torque - FRICTION + weight[place]
            states.append((instant, angle, speed, (net - 0.5 * self.links.slope[place] * speed**2) / inertia[place]))
            return speed, net
        while time < duration:
            speed, net = note(time, (turn + (place + 0.5) / STEPS) * 2 * np.pi)
            energy += net * step
            supply = SUPPLY * (1.0 + 0.012 * math.sin(0.5 * time)) - max(torque - RELIEF, 0.0) / RELIEF_SLOPE
            torque += SPRING * (supply / speed - 1.0) * step
            place += 1
            if place < STEPS:
                time += 2.0 * step / (speed + (2.0 * energy / inertia[place])**0.5)
            else:
                place -= 1
                blow = time + 0.5 * step / speed
                speed, _ = note(blow - 1e-9, (turn + 1) * 2 * np.pi - 1e-9)
                leaves = draws.uniform(*RESTITUTION) * loss * speed  # rocker as it leaves the tool [rad/s]
                self.blows.append((blow, 0.5 * ROCKER_INERTIA * ((loss * speed)**2 - leaves**2)))
                energy = 0.5 * after * ((others * speed + ROCKER_INERTIA * gain * leaves) / after)**2
                place, turn, weight = 0, turn + 1, self.weights(time)
                speed, _ = note(blow, turn * 2 * np.pi)
                time = blow + 0.5 * step / speed
        self.time, self.angle, self.speed, self.acceleration = np.array(states).T

    def weights(self, time):
        """Torque of the links' weight on the shaft."""
        pitch = pitch_of(time)
        x, z = in_hull(self.links.momentum)
        return GRAVITY * (x * np.sin(pitch) - z * np.cos(pitch))

    def at(self, time):
        """Angle, speed, acceleration; before the work begins it stands."""
        return tuple(np.where(time < STANDS, rest, np.interp(time, self.time, values))
                     for rest, values in ((self.angle[0], self.angle), (0.0, self.speed), (0.0, self.acceleration)))

    def wrench(self, time):
        """Force x, z [N] and moment about y [N m] on the hull, by links and flywheel, with their weight."""
        angle, speed, acceleration = self.at(time)
        links, pitch = self.links, pitch_of(time)
        place = np.mod(angle, 2 * np.pi)

        def table(values):
            return np.interp(place, links.angle, values)
        force = -(table(links.momentum_slope) * speed**2 + table(links.momentum) * acceleration)
        x, z = in_hull(force)
        moment = -(table(links.angular_slope) * speed**2 + (table(links.angular) + DRIVE_INERTIA) * acceleration)
        of_x, of_z = in_hull(table(links.moment))
        mass = CRANK_MASS + ROD_MASS + ROCKER_MASS
        along_x, along_z = GRAVITY * np.sin(pitch), -GRAVITY * np.cos(pitch)
        return x + mass * along_x, z + mass * along_z, moment + of_z * along_x - of_x * along_z


def messages(work, duration, seed):
    """(topic, stamp [s], names, positions) in time order, as the machine's driver publishes them."""
    draws = np.random.default_rng(seed + 1)
    taken = np.arange(1, int(duration * RATE)) / RATE
    angle = work.at(taken)[0]
    off = ECCENTRICITY * (np.sin(angle + ECCENTRICITY_PHASE) - np.sin(ECCENTRICITY_PHASE))
    count = 2 * np.pi / COUNTS
    reading = np.floor(np.mod(ZERO + DIRECTION * (angle + off), 2 * np.pi) / count) * count
    stamps = taken + draws.normal(0.0, STAMP_NOISE, taken.size)
    crank = [("/loader2/drive", START + stamp, ["drive_encoder"], [value]) for stamp, value in zip(stamps, reading)]
    times = np.arange(1, int(duration * ARM_RATE)) / ARM_RATE
    boom = [("/loader2/arm", START + time, ["lift", "tilt"], list(arm(time))) for time in times]
    return sorted(crank + boom, key=lambda message: message[1])
