"""How often the intervals of a fit hold the truth, under errors that laboratories have.

    python -m research.coverage [--draws 200] [--only WORDS] [--processes 2]

In each situation a known solid is measured again and again, each time with fresh errors, and
fitted; counted is how often the 90 % interval of each quantity holds the true value. A bound ("at
least") holds where the truth is not beyond it. 200 draws tell a coverage of 90 % to +-2 %.
Takes a quarter of an hour on two cores.
"""

import argparse
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from viscotack.lab import CreepTest, MasterCurve, RelaxationTest, fit
from viscotack.model.materials import (
    FractionalZener,
    Prony,
    RelaxationPowerLaw,
    RetardationPowerLaw,
    StandardSolid,
    published,
)

Errors = Callable[[np.random.Generator, np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Situation:
    """A true solid, how and where it is measured, with which errors, and what is fitted."""

    words: str
    solid: Any
    model: str
    test: str
    at: tuple[float, float, int]
    errors: Errors
    sweeps: int = 0

    def measured(self, seed: int) -> Any:
        """Return one measurement."""
        random = np.random.default_rng(seed)
        x, sweep = self.places()
        if self.test == "dma":
            modulus = self.solid.complex_modulus(x)
            common = self.errors(random, x, sweep)
            storage, loss = modulus.real * np.exp(common[0]), modulus.imag * np.exp(common[1])
            return MasterCurve(293.15, x, storage, loss, "E", sweep=sweep)
        error = np.exp(self.errors(random, x, sweep)[0])
        if self.test == "creep":
            return CreepTest(x, self.solid.creep(x) * error, "E")
        return RelaxationTest(x, self.solid.relaxation(x) * error, "E")

    def places(self) -> tuple[np.ndarray, np.ndarray]:
        """Return frequencies or times, and the sweep of each: sweeps overlap by half of each."""
        low, high, count = self.at
        if not self.sweeps:
            return np.geomspace(low, high, count), np.zeros(count, dtype=int)
        starts = np.linspace(0, 1, self.sweeps + 1)[:-1]
        reach = 2 / (self.sweeps + 1)
        each = count // self.sweeps
        part = (
            starts[:, None] * (1 - reach) / starts[-1] + reach * np.linspace(0, 1, each)
        ).ravel()
        return low * (high / low) ** part, np.repeat(np.arange(self.sweeps), each)


def plain(size: float) -> Errors:
    """Return errors of one size, each its own."""
    return lambda random, x, sweep: size * random.normal(size=(2, x.size))


def growing(first: float, last: float) -> Errors:
    """Return errors that grow along the axis."""

    def drawn(random: np.random.Generator, x: np.ndarray, sweep: np.ndarray) -> np.ndarray:
        part = np.log(x / x.min()) / np.log(x.max() / x.min())
        return first * (last / first) ** part * random.normal(size=(2, x.size))

    return drawn


def clamped(clamp: float, own: float) -> Errors:
    """Return one error for both moduli of a sweep, and small ones of each point."""

    def drawn(random: np.random.Generator, x: np.ndarray, sweep: np.ndarray) -> np.ndarray:
        common = clamp * random.normal(size=sweep.max() + 1)
        return common[sweep] + own * random.normal(size=(2, x.size))

    return drawn


def drifting(drift: float, decades: float, own: float) -> Errors:
    """Return a drift that wanders over so many decades of time, and small errors of each point."""

    def drawn(random: np.random.Generator, x: np.ndarray, sweep: np.ndarray) -> np.ndarray:
        apart = np.abs(np.log10(x)[:, None] - np.log10(x)) / decades
        root = np.linalg.cholesky(np.exp(-apart) + 1e-9 * np.eye(x.size))
        return drift * (root @ random.normal(size=(x.size, 2))).T + own * random.normal(
            size=(2, x.size)
        )

    return drawn


LAW = dict(rubbery_modulus=1e6, glassy_modulus=1e8, poisson_ratio=0.5)
THESIS = published("pdms-10-1").material
POWER = RetardationPowerLaw(**LAW, exponent=0.5, tau0=1e-2)
RELAXING = RelaxationPowerLaw(**LAW, exponent=0.6, tau0=1e-4)
STANDARD = StandardSolid(**LAW, tau0=1.0)
ZENER = FractionalZener(**LAW, order=0.6, tau0=1.0)
ARMS = Prony(
    rubbery_modulus=1e6, branches=[(3e6, 1e-4), (2e7, 1e-2), (1e6, 1.0)], poisson_ratio=0.5
)

SITUATIONS = (
    Situation("power law, the thesis's 16 points", THESIS, "power-law", "dma",
              (0.7, 4e20, 16), plain(0.02)),
    Situation("power law by relaxation, relaxation test", RELAXING, "relaxation-power-law",
              "relaxation", (1e-7, 1e3, 50), plain(0.02)),
    Situation("standard solid, sweep", STANDARD, "sls", "dma", (1e-2, 1e4, 30), plain(0.02)),
    Situation("fractional Zener, sweep", ZENER, "fractional-zener", "dma",
              (1e-4, 1e8, 40), plain(0.02)),
    Situation("power law, glassy plateau not measured", POWER, "power-law", "dma",
              (1e-1, 1e5, 40), plain(0.02)),
    Situation("power law, noise 1 to 8 %", POWER, "power-law", "dma",
              (1e-1, 1e12, 40), growing(0.01, 0.08)),
    Situation("power law, clamp 3 %, 8 sweeps", POWER, "power-law", "dma",
              (1e-1, 1e12, 104), clamped(0.03, 0.005), sweeps=8),
    Situation("standard solid, drifting creep", STANDARD, "sls", "creep",
              (1e-4, 1e2, 60), drifting(0.02, 1.0, 0.005)),
    Situation("Prony, both plateaus measured", ARMS, "prony", "dma", (1e-2, 1e7, 40), plain(0.02)),
    Situation("Prony, end of the glassy plateau", ARMS, "prony", "dma",
              (1e-2, 3e4, 40), plain(0.02)),
    Situation("Prony, glassy plateau not measured", ARMS, "prony", "dma",
              (1e-2, 2e3, 40), plain(0.02)),
    Situation("Prony of a power law, relaxation test", POWER, "prony", "relaxation",
              (1e-11, 1e3, 60), plain(0.02)),
    Situation("Prony, creep", ARMS, "prony", "creep", (1e-6, 1e3, 60), plain(0.02)),
    Situation("Prony, noise 1 to 8 %", ARMS, "prony", "dma", (1e-2, 1e7, 60), growing(0.01, 0.08)),
    Situation("Prony, clamp 3 %, 8 sweeps", ARMS, "prony", "dma",
              (1e-2, 1e7, 104), clamped(0.03, 0.005), sweeps=8),
    Situation("Prony, drifting creep", ARMS, "prony", "creep",
              (1e-6, 1e3, 60), drifting(0.02, 1.0, 0.005)),
)  # fmt: skip


def held(number: int, seed: int) -> list[tuple[str, bool, bool, float]]:
    """Return of each quantity: name, whether its interval holds the truth, is bounded, width."""
    situation = SITUATIONS[number]
    report = fit(
        situation.measured(seed), poisson_ratio=0.5, model=situation.model, draws=1, seed=seed
    )
    found = []
    for each in report.intervals:
        truth = float(getattr(situation.solid, each.name))
        width = np.log(each.high / each.low) / 2 if each.bounded else np.inf
        found.append((each.name, each.low <= truth <= each.high, each.bounded, float(width)))
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--only", default="", help="situations with these words")
    parser.add_argument("--processes", type=int, default=2)
    asked = parser.parse_args()
    print(f"coverage of 90 % intervals, {asked.draws} draws")
    print(f"| {'situation':42} | {'quantity':16} | held | bounded | half width | s each |")
    print(f"|{'-' * 44}|{'-' * 18}|------|---------|------------|--------|")
    with ProcessPoolExecutor(asked.processes) as pool:
        for number, situation in enumerate(SITUATIONS):
            if asked.only not in situation.words:
                continue
            began = time.perf_counter()
            seeds = range(asked.draws)
            rows = list(pool.map(held, [number] * asked.draws, seeds, chunksize=10))
            each = (time.perf_counter() - began) / asked.draws
            for i, (name, *_) in enumerate(rows[0]):
                inside = np.mean([row[i][1] for row in rows])
                bounded = np.mean([row[i][2] for row in rows])
                width = np.median([row[i][3] for row in rows])
                size = f"{100 * width:9.2g} %" if np.isfinite(width) else "     bound "
                print(
                    f"| {situation.words if not i else '':42} | {name:16} | {100 * inside:3.0f} % "
                    f"| {100 * bounded:5.0f} % | {size} | {each:6.2f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
