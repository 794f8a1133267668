"""Figures 3 and 5 of P0 and figures 3 to 6 of P4, as examples/papers.py --pictures draws them."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)
import numpy as np  # noqa: E402
import papers  # noqa: E402
from working_turn import WHOLE, Turn  # noqa: E402

PRINTED = {"H": 39895.0, "mu": 170.0, "t1": 0.1815}
FAST, WORK, THIRD = "#1f5fa8", "#d1602b", "#8a8f98"


def panels(count, size):
    figure, axes = plt.subplots(1, count, figsize=size, dpi=100, layout="constrained")
    for each in axes:
        each.grid(color="#ececec")
        each.set_axisbelow(True)
        for side in ("top", "right"):
            each.spines[side].set_visible(False)
    return figure, axes


def save(figure, path):
    figure.savefig(path, metadata={"Software": None})  # the same bytes from every version
    plt.close(figure)


def inertia_forces(hammer, folder):
    """P0, figure 3. At work the tangential force also has the part of the crank's acceleration."""
    angle = np.linspace(0.0, WHOLE, 1441)[:-1]
    p, (u, du) = hammer.parameters, papers.transfer(hammer, angle)
    first = p["rocker_mass_kg"] * p["rocker_com_distance_m"] / 1e3
    figure, axes = panels(2, (9.0, 3.2))
    for turn, color, name in ((Turn.at_speed(hammer, papers.SPEED), FAST, "constant 31.416 rad/s (P0)"),
                              (Turn.at_energy(hammer, papers.ENERGY), WORK, "at work, blows of 1000 J")):
        w, e = turn.speed(angle), turn.acceleration(angle)
        axes[0].plot(np.degrees(angle), -first * (du * w ** 2 + u * e), color=color, label=name)
        axes[1].plot(np.degrees(angle), first * (u * w) ** 2, color=color, label=name)
    axes[0].set(title="(a) tangential", xlabel="crank angle [deg]", ylabel="inertia force of the rocker [kN]")
    axes[1].set(title="(b) normal", xlabel="crank angle [deg]")
    axes[0].legend(frameon=False)
    save(figure, folder / "papers_p0_figure3.png")


def pulse(turn, time):
    s = turn.half_sine()
    return np.where(time > s["t1"], s["H"] * np.sin(s["mu"] * (time - s["t1"])), 0.0)


def hull_forces(hammer, folder):
    """P0, figure 5, at P0's speed and at work."""
    figure, axes = panels(2, (9.5, 3.8))
    angle = np.linspace(0.0, WHOLE, 1441)
    for ax, turn, title in ((axes[0], Turn.at_speed(hammer, papers.SPEED), "constant 31.416 rad/s (P0), 5308 J"),
                            (axes[1], Turn.at_energy(hammer, papers.ENERGY), "at work, 1000 J")):
        time = np.array([turn.time(a) for a in angle[::12]])
        time = np.interp(angle, angle[::12], time)
        force = turn.loads(np.minimum(angle, WHOLE - 1e-13)) / 1e3
        ax.plot(1e3 * time, force[0], color=WORK, label="Fx (Rx of P0)")
        ax.plot(1e3 * time, force[1], color=FAST, label="Fz (Ry of P0)")
        ax.plot(1e3 * time, pulse(turn, time) / 1e3, "--", color="black", linewidth=1.2,
                label="half-sine, P0 (15), (16)")
        if turn.speed(np.array(0.0)) > 30.0:
            printed = np.where(time > PRINTED["t1"], PRINTED["H"] * np.sin(PRINTED["mu"] * (time - PRINTED["t1"])), 0.0)
            ax.plot(1e3 * time, printed / 1e3, ":", color=THIRD, linewidth=2.0, label="half-sine as printed")
        ax.set(title=title, xlabel="time since the blow [ms]", ylabel="force on the hull [kN]")
        ax.legend(frameon=False, fontsize=8, loc="lower left")
    save(figure, folder / "papers_p0_figure5.png")


def boom_moments(hammer, folder):
    """Torque on the boom's joint over a turn: all, without Fx, by the half-sine alone."""
    boom = papers.shipped_boom()
    turn = Turn.at_energy(hammer, papers.ENERGY)
    figure, axes = panels(2, (9.5, 3.4))
    for ax, compliant, title in ((axes[0], False, "rigid boom"), (axes[1], True, "boom on the oil of its cylinders")):
        for parts, color, name in (((1, 1, 1), FAST, "all"), ((0, 1, 1), WORK, "without Fx"),
                                   (None, THIRD, "half-sine of Fz alone")):
            time, result = papers.boom_turn(boom, turn, papers.POSES[0], parts, compliant)
            ax.plot(1e3 * time, result["boom_joint_torque_Nm"] / 1e3, color=color, label=name)
        ax.set(title=title, xlabel="time since the blow [ms]", ylabel="torque on boom_joint [kN m]")
    axes[0].legend(frameon=False)
    save(figure, folder / "papers_boom.png")


def grapple(folder):
    """P4, figures 3 to 6. Its input law is not printed: abscissa is the slider, derivatives are by the slider."""
    path = papers.grapple_path()
    figure, axes = panels(4, (13.0, 3.2))
    axes[0].plot(path["x_m"], path["y_m"], color=FAST)
    axes[0].plot(-path["x_m"], path["y_m"], color=THIRD)
    axes[0].set(title="figure 3: path of the edges", xlabel="x [m]", ylabel="y [m], stretched")
    for ax, x, y, title, unit in ((axes[1], "x_m", "y_m", "figure 4: displacement", "m"),
                                  (axes[2], "dx_ds", "dy_ds", "figure 5: velocity by slider speed", "-"),
                                  (axes[3], "d2x_ds2", "d2y_ds2", "figure 6: second derivative", "1/m")):
        ax.plot(path["s_m"], path[x], color=FAST, label="x")
        closed = path[y][0] if y == "y_m" else 0.0
        ax.plot(path["s_m"], path[y] - closed, color=WORK, label="y - y closed" if closed else "y")
        ax.set(title=title, xlabel="slider s [m]", ylabel=f"[{unit}]")
        ax.legend(frameon=False)
    save(figure, folder / "papers_p4_figures3to6.png")


def draw(hammer, folder):
    folder.mkdir(parents=True, exist_ok=True)
    inertia_forces(hammer, folder)
    hull_forces(hammer, folder)
    boom_moments(hammer, folder)
    grapple(folder)
