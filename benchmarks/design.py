"""Find designs for targets made from hidden designs, and refuse impossible targets.

    python benchmarks/design.py --designs 10 --seed 1
    python benchmarks/design.py --designs 10 --seed 1 --fixed-speeds
    python benchmarks/design.py --designs 5 --seed 2 --more-targets
    python benchmarks/design.py --impossible

The first draws material, interface and a hidden design between bounds, simulates the force that it
holds and the one that it releases, and makes these the targets. It counts the designs found whose
margin is at least that of the hidden one by the fast tier, and those that meet the targets by
simulation, so that they are at least as good as the hidden one; the best of up to three simulated
designs counts. The time is that of the processor for the search, without simulations. The second
fixes the speeds to those of the hidden design. The third has five targets of hidden designs: the
forces to hold and release, the work to pull-off, a dead load for a minute and the yield with
tolerances of radius (3 %) and work of adhesion (10 %). The fourth states targets beyond 1/k, beyond
the forces of the solid, and beyond what the speeds reach.
"""

import argparse
from dataclasses import replace
from math import log
from time import process_time

import numpy as np
from threadpoolctl import threadpool_limits

from viscotack import LennardJones, RetardationPowerLaw, StandardSolid
from viscotack.design import Bounds, Choice, Conditions, DesignSpace, Targets, find_design
from viscotack.design.confirming import simulate
from viscotack.design.fast import SURROGATES, FastTier
from viscotack.design.finding import slopes_of
from viscotack.design.margins import Judge
from viscotack.design.yields import share_of

# Ranges of the bounds, of which each hidden design has its own.
_RADII, _PRELOADS, _PADS = (3e-4, 1e-2), (1e-4, 3e-2), 12
_HOLD, _RELEASE = (1e-5, 1e-2), (1e-7, 1e-5)
# Width of a drawn range, decades.
_WIDTHS = (0.3, 1.0)


def drawn(random):
    """Draw a material, an interface and a space with a hidden design in it."""
    rubbery = 10 ** random.uniform(5.8, 6.5)
    ratio = 10 ** random.uniform(-3, -1)
    solid = {
        "rubbery_modulus": rubbery,
        "glassy_modulus": rubbery / ratio,
        "tau0": 10 ** random.uniform(-3, 0),
        "poisson_ratio": 0.5,
    }
    is_power_law = random.random() < 0.6
    exponent = random.uniform(0.2, 0.9)
    material = (
        RetardationPowerLaw(**solid, exponent=exponent) if is_power_law else StandardSolid(**solid)
    )
    # the surrogate of solids ends at a Tabor number of 10
    gap = 10 ** (random.uniform(-8, -6.5) if is_power_law else random.uniform(-6.7, -6))
    law = LennardJones(work_of_adhesion=10 ** random.uniform(-1.5, -0.8), equilibrium_gap=gap)

    def around(low, high):
        """Return bounds with a value in them."""
        value = np.exp(random.uniform(np.log(low), np.log(high)))
        share, decades = random.uniform(0, 1), random.uniform(*_WIDTHS)
        return value, Bounds(
            value * 10 ** (-share * decades), value * 10 ** ((1 - share) * decades)
        )

    radius, of_radius = around(*_RADII)
    preload, of_preload = around(*_PRELOADS)
    hold, of_hold = around(*_HOLD)
    release, of_release = around(*_RELEASE)
    pads = int(random.integers(1, _PADS + 1))
    space = DesignSpace(of_radius, of_preload, of_hold, of_release, Bounds(1, _PADS))
    return material, law, space, Choice("drawn", radius, preload, pads, hold, release)


# Holding time [s], tolerances, and parts of the forces of hidden designs that are targets.
_TIME, _DEVIATIONS = 60.0, {"radius": 0.03, "work_of_adhesion": 0.1}
_LESS, _MORE = 0.85, 1.15


def hidden(random, more):
    """Draw until a surrogate predicts the hidden design and a simulation gives its targets."""
    while True:
        material, law, space, choice = drawn(random)
        fast = FastTier({"drawn": material}, law, SURROGATES)
        asked = {"work": 1.0, "dead_load": 1.0, "holding_time": _TIME} if more else {}
        judge = Judge(Targets(ratio=1.0, **asked))
        known = judge.judged(choice, fast)
        if isinstance(known, str) or known.margins["ratio"] < log(1.2):
            continue
        run = simulate(known, fast, judge, accuracy=2e-3)
        if run.margin is None:
            continue
        if not more:
            targets = Targets(hold=run.hold, release=run.release)
            return fast, space, Judge(targets), Judge(targets).judged(choice, fast)
        targets = Targets(
            hold=_LESS * run.hold,
            release=_MORE * run.release,
            work=_LESS * run.forces["work"],
            dead_load=_LESS * run.forces["dead_load"],
            holding_time=_TIME,
        )
        judge = Judge(targets)
        slopes = slopes_of(choice, fast, judge)
        share = share_of(judge.margins(choice, run.forces), slopes, _DEVIATIONS)
        judge = Judge(targets, Conditions(deviations=_DEVIATIONS, share=min(share, 0.99)))
        return fast, space, judge, judge.judged(choice, fast)


def compare(count, seed, fixed, more):
    """Find designs for the targets of hidden ones; print a line each and the counts."""
    random = np.random.default_rng(seed)
    as_good = met = decided = 0
    times, whole = [], []
    for number in range(1, count + 1):
        fast, space, judge, one = hidden(random, more)
        targets = judge.targets
        if fixed:
            at = one.choice
            space = replace(
                space, hold_speed=Bounds(at.hold_speed), release_speed=Bounds(at.release_speed)
            )
        begin = process_time()
        searched = []

        def tell(share, searched=searched, begin=begin):
            if share <= 0.6:
                searched.append(process_time() - begin)

        found = find_design(
            fast.materials,
            fast.traction,
            space,
            targets,
            judge.conditions,
            seed=seed,
            accuracy=2e-3,
            progress=tell,
        )
        whole.append(process_time() - begin)
        times.append(searched[-1])
        runs = [each for each in found.simulated if each is not None]
        run = found.simulated[0]
        best = max(each.margin for each in found.candidates)
        as_good += best >= one.margin
        met += bool(found.meets)
        decided += found.meets is not None
        part = "" if not more else f", yield {found.yields[0]:.3f} of {judge.conditions.share:.3f}"
        print(
            f"{number:3d} {type(fast.materials['drawn']).__name__:20s} hold {targets.hold:.3g} N, "
            f"release {targets.release:.3g} N: hidden {one.margin:+.3f}, found {best:+.3f}, "
            f"simulated {_words(run)} of {len(runs)}{part}, {found.best.hold.method}, "
            f"{times[-1]:.1f} s, with simulations {whole[-1]:.1f} s, {found.predictions} "
            f"predictions, front of {len(found.front)}",
            flush=True,
        )
    print(
        f"at least as good: {as_good} of {count}; targets met by simulation: {met} of {decided} "
        f"simulated; processor time {min(times):.1f} to {max(times):.1f} s, with simulations "
        f"{min(whole):.1f} to {max(whole):.1f} s"
    )


def _words(run):
    if run is None:
        return "none"
    return run.why if run.margin is None else f"{run.margin:+.3f}"


def impossible():
    """State three targets out of reach and print the bound of each."""
    material = RetardationPowerLaw(
        rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.6, tau0=0.1, poisson_ratio=0.5
    )
    law = LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-7)
    space = DesignSpace(
        Bounds(1e-3, 4e-3),
        Bounds(1e-3, 1e-2),
        hold_speed=Bounds(1e-5, 1e-3),
        release_speed=Bounds(1e-7, 1e-5),
        pads=Bounds(1, 4),
    )
    slower = replace(space, hold_speed=Bounds(1e-6, 1e-5), release_speed=Bounds(1e-6, 1e-5))
    for words, where, targets in (
        ("beyond 1/k", space, Targets(ratio=20.0)),
        ("beyond the glassy force", space, Targets(hold=0.1, release=0.05)),
        ("beyond the speeds", slower, Targets(hold=6e-3, release=1e-3)),
    ):
        found = find_design({"drawn": material}, law, where, targets)
        print(f"{words}: meets {found.meets}, margin {found.best.margin:+.3f}")
        for each in found.excluded:
            print(f"  {each.target} {each.wanted:.4g}, reach {each.reach:.4g} ({each.cause})")
            print(f"  {each.why}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--designs", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fixed-speeds", action="store_true")
    parser.add_argument("--more-targets", action="store_true")
    parser.add_argument("--impossible", action="store_true")
    asked = parser.parse_args()
    with threadpool_limits(limits=1, user_api="blas"):
        if asked.impossible:
            impossible()
        else:
            compare(asked.designs, asked.seed, asked.fixed_speeds, asked.more_targets)


if __name__ == "__main__":
    main()
