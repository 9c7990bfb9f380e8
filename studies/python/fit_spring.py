"""Fits a spring to a filmed deployment, and carries the fit's uncertainty into a campaign of the flight wing.

    PYTHONPATH=build/release/python /usr/bin/python3 studies/python/fit_spring.py [--plot FILE.png]

A panel of known inertia was released on a rig, and its angle was read off a film. The script estimates the spring's torques,
stowed and latched, with their covariance, and the scatter of the wing's deployment that follows from it.

The measurement is synthetic: SciPy's solve_ivp integrates the rig's equation of motion, written below and not taken from
wingspread, and noise is added. So the true spring is known and the answer is checked. For a film of your own, replace
measure() by its times and angles.
"""

import argparse
import sys

import numpy as np
from scipy import integrate, optimize, stats

import wingspread

TRUE = np.array([2.0, 1.4])  # N·m: torque stowed, torque latched
STOWED = np.pi / 2  # rad; latched at 0
MASS, INERTIA, ARM, FRICTION = 10.0, 0.9, 0.505, 0.15  # kg, kg·m², m from hinge to centre of mass, N·m
NOISE = np.radians(0.2)  # of one reading
PATHS = ["hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"]

RIG = {"name": "rig", "base": {"motion": "fixed"},
       "bodies": [{"name": "panel", "mass": MASS, "inertia": INERTIA}],
       "hinges": [{"name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0],
                   "child_point": [-ARM, 0], "angle": {"stowed": STOWED, "latched": 0},
                   "spring": {"torque_stowed": 1.5, "torque_latched": 1.5},
                   "friction": {"coulomb": FRICTION, "model": "exact"}}]}


def measure(rng):
    """Times and angles of the film, 25 pictures a second, up to shortly before the panel latches."""
    about_hinge = INERTIA + MASS * ARM**2

    def motion(_, state):
        travel = (STOWED - state[0]) / STOWED
        torque = TRUE[0] + (TRUE[1] - TRUE[0]) * travel - FRICTION
        return [state[1], -torque / about_hinge]

    t = np.arange(0, 3, 0.04)
    angle = integrate.solve_ivp(motion, (0, 3), [STOWED, 0], t_eval=t, rtol=1e-11, atol=1e-12).y[0]
    before_latching = angle > 0.05
    return t[before_latching], angle[before_latching] + NOISE * rng.standard_normal(before_latching.sum())


def fit(t, angle):
    """The spring's two torques and their covariance, by least squares over whole simulated deployments."""
    def residuals(torques):
        # tolerances far below the noise, and steps far above the tolerances: the derivatives are differences
        motion = wingspread.simulate(RIG, set=dict(zip(PATHS, torques)), dt=t[1] - t[0], t_end=t[-1] + 0.01,
                                     rtol=1e-11, atol=1e-12).trajectory
        return motion["root.angle"][:len(t)] - angle

    found = optimize.least_squares(residuals, [1.5, 1.5], diff_step=1e-4)
    variance = 2 * found.cost / (len(t) - len(found.x))  # of a reading
    return found.x, variance * np.linalg.inv(found.jac.T @ found.jac), np.sqrt(variance)


def campaign(torques, covariance, runs, correlated=True):
    """The wing in flight, with a latch: both torques normal, and correlated as the fit left them."""
    flight = {**RIG, "hinges": [{**RIG["hinges"][0], "latch": {"stiffness": 1e4, "damping": 100}}]}
    sigma = np.sqrt(np.diag(covariance))
    pearson = covariance[0, 1] / (sigma[0] * sigma[1])
    made = {"scene": flight,
            "dispersions": [{"name": name, "apply": "set", "to": [path],
                             "distribution": {"type": "normal", "mean": mean, "std": std}}
                            for name, path, mean, std in zip(("stowed", "latched"), PATHS, torques, sigma)],
            "sampling": {"runs": runs, "seed": 1}, "outputs": ["latch_time", "latch_rate"]}
    if correlated:
        made["correlations"] = [{"between": ["stowed", "latched"], "covariance": covariance[0, 1]}]
    return made, pearson


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--plot", help="draw measurement, fit and residuals into this file")
    arguments.add_argument("--runs", type=int, default=4000)
    options = arguments.parse_args()

    t, angle = measure(np.random.default_rng(20))
    torques, covariance, noise = fit(t, angle)
    sigma = np.sqrt(np.diag(covariance))
    print(f"{len(t)} readings, {np.degrees(noise):.2f}° each by their scatter about the fit (put in: "
          f"{np.degrees(NOISE):.2f}°)")
    for name, value, std, true in zip(("stowed", "latched"), torques, sigma, TRUE):
        print(f"torque {name:8} {value:.3f} ± {std:.3f} N·m (put in: {true})")
    distance = (torques - TRUE) @ np.linalg.solve(covariance, torques - TRUE)
    inside = distance < stats.chi2.ppf(0.99, 2)
    print(f"the true spring lies {'inside' if inside else 'OUTSIDE'} the fit's 99 % ellipse (χ² = {distance:.2f} of 2)")

    made, pearson = campaign(torques, covariance, options.runs)
    relative = 100 * sigma / torques
    print(f"""
The film knows the torque at the start to {relative[0]:.1f} % and that at the end to {relative[1]:.1f} %: the panel is slow at
first, and so spends most of the film there. Their errors are correlated by {pearson:.2f}, for a spring that is stronger
at first and weaker later comes as far in the same time.""")

    runs = wingspread.run(made)
    alone = wingspread.run(campaign(torques, covariance, options.runs, correlated=False)[0])
    print(f"\nIn flight, {runs.size} runs: by the fit's covariance and, wrongly, by its standard deviations alone")
    scatter = {}
    for name, unit in (("root.latch_time", "s"), ("root.latch_rate", "rad/s")):
        scatter[name] = runs[name].std(ddof=1), alone[name].std(ddof=1)
        print(f"{name:16} {runs[name].mean():8.4f} ± {scatter[name][0]:.5f} {unit:6}   ± {scatter[name][1]:.5f}")

    # The rate at the latch is what the spring's work leaves the panel with: W − F φ = ½ I ω², so σ_ω = σ_W / (I ω),
    # and W = φ (T_s + T_l)/2.
    about_hinge = INERTIA + MASS * ARM**2
    half = np.ones(2) / 2
    work, work_sigma = STOWED * half @ torques, STOWED * np.sqrt(half @ covariance @ half)
    rate = np.sqrt(2 * (work - FRICTION * STOWED) / about_hinge)
    expected = work_sigma / (about_hinge * rate)
    print(f"""
Over the whole way the spring does {work:.3f} ± {work_sigma:.3f} J of work, and by the balance of energy the panel latches at
{rate:.4f} ± {expected:.5f} rad/s, as the runs say. The time to the latch is what the film has seen, and known far better
than either torque: whoever forgets the correlation gives it {scatter["root.latch_time"][1] / scatter["root.latch_time"][0]:.1f} times its scatter, and the rate {scatter["root.latch_rate"][1] / scatter["root.latch_rate"][0]:.1f} times.""")
    if options.plot:
        plot(t, angle, torques, options.plot)
    ratio = scatter["root.latch_rate"][0] / expected
    agrees = abs(ratio - 1) < 4 / np.sqrt(2 * runs.size) + 0.01  # of a standard deviation, and of the linearisation
    return 0 if inside and agrees else 1


def plot(t, angle, torques, file):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    motion = wingspread.simulate(RIG, set=dict(zip(PATHS, torques)), dt=t[1], t_end=t[-1] + 0.01).trajectory
    figure, (upper, lower) = pyplot.subplots(2, sharex=True, height_ratios=[3, 1])
    upper.plot(t, np.degrees(angle), ".", label="measured")
    upper.plot(motion["t"], np.degrees(motion["root.angle"]), label="fitted")
    upper.set_ylabel("hinge angle, °")
    upper.legend()
    lower.plot(t, np.degrees(angle - motion["root.angle"][:len(t)]), ".")
    lower.set(xlabel="time, s", ylabel="residual, °")
    figure.savefig(file, dpi=120)


if __name__ == "__main__":
    sys.exit(main())
