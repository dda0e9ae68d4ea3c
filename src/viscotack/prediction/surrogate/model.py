"""Surrogate of a contact: physical baseline, learned correction, intervals and their range.

It needs NumPy only. :mod:`viscotack.prediction.surrogate.contact` defines the physical baseline.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from statistics import NormalDist
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError

from .contact import LEAST_WAY, Contact, between, mean_limit
from .line import Curves
from .network import Networks
from .trust import Answers, Intervals, Trust

# Step of the logarithm of an input in differences, where rounding and curvature balance.
_STEP = 3e-4


@dataclass(frozen=True, eq=False)
class Surrogate:
    """Predict force, work and curve of a contact retracted from a relaxed start at constant speed.

    Attributes
    ----------
    contact : type of Contact
        Inputs with their ranges, limits of the force, and inputs of the networks.
    networks : mapping of str to Networks
        Learned correction: position of the force between its limits, then work and curve.
    trust : Trust or None
        Widths of the intervals; None if they were not measured.
    constants : mapping of str to ndarray
        Further fitted numbers of the contact.

    Notes
    -----
    Methods accept rows of inputs in the order of ``contact.inputs``, shape (n, inputs); for solids
    other than power laws the output of :func:`.linear_solids.like`; or the :meth:`tests` of these.
    :meth:`inside` checks the training range; the other methods do not.
    """

    contact: type[Contact]
    networks: Mapping[str, Networks]
    trust: Trust | None = None
    constants: Mapping[str, Array] = field(default_factory=dict)

    def tests(self, given: Any) -> Contact:
        """Return the tests, whose limits and starts are computed once for all methods."""
        if isinstance(given, Contact):
            if given.networks is not self.networks:
                raise InputError("these tests belong to another surrogate; give their inputs")
            return given
        return self.contact.of(self.networks, self.constants, given)

    def having(self, **networks: Networks) -> Surrogate:
        """Return a copy with some networks replaced or added."""
        return replace(self, networks={**self.networks, **networks})

    # Where it ends --------------------------------------------------------------------------

    @property
    def limits(self) -> Mapping[str, tuple[float, float]]:
        """Smallest and largest training value of each input, in the units of its range."""
        return _by_name(self.contact.inputs, self.contact.low, self.contact.high)

    def limits_of(self, row: Array) -> Mapping[str, tuple[float, float]]:
        """Return the range of each input for a test whose other inputs are given.

        The largest depth of a punch's start depends on its size and on the layer.

        Examples
        --------
        >>> from viscotack.prediction.surrogate.store import shipped
        >>> low, high = shipped("punch").limits_of([64.85, 3.24, 0.1, 1.0, 1.0])["preload"]
        >>> f"{low:.2g} to {high:.2g} h0"
        '0.0074 to 49 h0'
        """
        ends = np.array([self.contact.low, self.contact.high])
        with np.errstate(invalid="ignore", divide="ignore"):
            unit = self.contact.unit(np.asarray(row, dtype=float)[None])
        return _by_name(self.contact.inputs, *(ends if unit is None else ends * unit))

    def inside(self, given: Any) -> npt.NDArray[np.bool_]:
        """Return a mask of the inputs inside the training range, shape (n, inputs).

        For solids other than power laws two columns follow: size and direction of their
        dissimilarity.
        """
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.tests(given).inside()

    # Evaluation -----------------------------------------------------------------------------

    def evaluate(self, given: Any) -> Answers:
        """Predict force and work."""
        tests = self.tests(given)
        slow, fast = tests.slow, tests.fast
        output = self.networks["force"](tests.told)[..., 0]
        further = tests.further(output)
        if further.force is not None:
            output = output + further.force
        forces = between(slow, fast, output)
        force, slow, fast = forces.mean(axis=0), mean_limit(slow), mean_limit(fast)
        way = np.maximum(fast - slow, LEAST_WAY)
        work = work_spread = np.full(len(tests.rows), np.nan)
        if "work" in self.networks:
            works = force + self.networks["work"](tests.knowing(force))[..., 0]
            if further.work is not None:
                works = works + further.work
            work, work_spread = 10 ** works.mean(axis=0), works.std(axis=0)
        return Answers(
            pull_off_force=10**force,
            work_to_pull_off=work,
            force_spread=forces.std(axis=0),
            work_spread=work_spread,
            way=way,
            share=(force - slow) / way,
            more=further.more,
        )

    def curves(self, given: Any, answers: Answers) -> Curves:
        """Return the unloading curves of the predictions of the same tests."""
        return self.tests(given).curves(answers)

    def intervals(
        self, given: Any, answers: Answers, *, confidence: float = 0.9, joint: bool = False
    ) -> Intervals:
        """Return intervals with a measured coverage on validation cases.

        Joint ones are wider: force, work and curve together are inside with this confidence.

        Raises
        ------
        ValueError
            If the coverage was not measured for this confidence.
        """
        if self.trust is None:
            raise InputError(f"no intervals were measured for a {self.contact.name}")
        tests = self.tests(given)
        told = tests.told_of_errors(answers)
        found = self.trust.intervals(told, answers, confidence, joint=joint)
        if tests.least is None:
            return found
        ends = found.pull_off_force
        force = np.column_stack([np.maximum(ends[:, 0], 10**tests.least), ends[:, 1]])
        return replace(found, pull_off_force=force)

    def doubtful(self, given: Any, answers: Answers) -> npt.NDArray[np.bool_]:
        """Return a mask of the forces and works that are not certain, shape (n, 2).

        :meth:`.trust.Trust.doubtful` has the conditions.
        Without intervals or second networks no number is doubtful.
        """
        if self.trust is None or "second" not in self.networks:
            return np.column_stack([answers.pull_off_force] * 2) < 0  # none, also in an export
        return self.trust.doubtful(self.tests(given).told_of_errors(answers))

    def slopes(self, groups: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the derivatives of log force and log work by the logarithms of the inputs.

        They are central differences of fourth order; their error is below 1e-10, except within
        6e-4 of a kink.

        Parameters
        ----------
        groups : array_like, shape (n, inputs)
            Inputs, not checked to be inside the range.

        Returns
        -------
        force, work : ndarray, shape (n, inputs)
            Relative change of the prediction over relative change of the input; the derivative by
            the input itself is this times prediction over input.

        Raises
        ------
        ValueError
            For the contacts ``"solids"`` and ``"short range"``.

        Examples
        --------
        >>> from viscotack.prediction.surrogate.store import shipped
        >>> force, _ = shipped().slopes([[3.24, 0.1, 0.8, 73.0, 316.23]])
        >>> bool(0 < force[0, 4] < 0.5)
        True
        """
        if not self.contact.smooth:
            raise InputError(
                f"the surrogate {self.contact.name!r} has no derivatives: inputs of its networks "
                "come from an iteration"
            )
        rows, force, work = self.tests(groups).rows, [], []
        for column in np.eye(len(self.contact.inputs)):
            near = [self.evaluate(rows * np.exp(_STEP * i * column)) for i in (-2, -1, 1, 2)]
            for found, name in ((force, "pull_off_force"), (work, "work_to_pull_off")):
                low, below, above, high = (np.log(getattr(each, name)) for each in near)
                found.append((low - high + 8 * (above - below)) / (12 * _STEP))
        return np.column_stack(force), np.column_stack(work)

    # Starts ---------------------------------------------------------------------------------

    def start_depth(
        self, *known: float, force: float | None = None, contact_radius: float | None = None
    ) -> float:
        """Find the depth [h0] of the relaxed start with a given force or contact radius.

        Valid for the Lennard-Jones law with its finite range, as simulated; for forces of
        short range see :func:`viscotack.theory.elastic.relaxed.contact`.

        Parameters
        ----------
        *known : float
            Inputs that define a start besides its depth: the Tabor number; for a punch size and
            thickness.
        force : float, optional
            [1.5 pi R dg0], for a punch mean stress [sigma0]; compression positive.
        contact_radius : float, optional
            [(pi R^2 dg0/E0*)^(1/3)]

        Raises
        ------
        ValueError
            If no start in the training range has this value.
        """
        if (force is None) == (contact_radius is None):
            raise InputError("give either the force or the contact radius of the start")
        which, wanted = (0, force) if force is not None else (1, contact_radius)
        assert wanted is not None
        *others, preload = self.contact.start_inputs
        count, looks = self.contact.search
        rows = np.ones((count, len(self.contact.inputs)))
        rows[:, others] = known
        low, high = self.limits_of(rows[0])[self.contact.inputs[preload]]
        i, found = 0, rows[:, preload]
        for look in range(looks):
            rows[:, preload] = np.geomspace(low, high, count)
            # in tension and at large Tabor numbers it rises by less than the error of the networks
            found = np.maximum.accumulate(self.tests(rows).start[which])
            if look == 0 and not found[0] <= wanted <= found[-1]:
                words = {"wanted": wanted, "least": found[0], "most": found[-1]}
                what = ("force [1.5 pi R dg0]", "contact radius")[which]
                raise InputError(
                    self.contact.no_start.format(what=what, low=low, high=high, **words)
                )
            i = min(max(int(np.searchsorted(found, wanted)), 1), count - 1)
            low, high = rows[i - 1, preload], rows[i, preload]
        rise = float(found[i] - found[i - 1])
        part = (wanted - float(found[i - 1])) / rise if rise > 0 else 0.5
        return float(low + min(max(part, 0.0), 1.0) * (high - low))

    def with_start_doubt(
        self, given: Any, answers: Answers, held: Intervals, *, by: str, confidence: float
    ) -> Intervals:
        """Widen intervals by the uncertainty of the depths of the starts.

        Parameters
        ----------
        given, answers, held : ndarray, Answers, Intervals
            Tests, their predictions, and the intervals without this uncertainty.
        by : {"depth", "force", "contact_radius"}
            Quantity that defined the start; its spread between the networks is the uncertainty. A
            depth and a single network give none.
        confidence : float
            Of the intervals.
        """
        if by == "depth" or len(self.networks["start"].weights[0]) == 1:
            return held
        tests = self.tests(given)
        quantile = NormalDist().inv_cdf((1 + confidence) / 2)
        doubt = 10 ** (quantile * _start_doubt(tests, by=by))
        others = self.evaluate(tests.deeper(np.stack([np.ones_like(doubt), doubt, 1 / doubt])))

        def wider(name: str) -> Array:
            value, pair = np.log(getattr(answers, name)), np.log(getattr(held, name))
            here, *there = np.log(getattr(others, name)).reshape(3, -1)
            far = np.array(there) - here
            down, up = -np.minimum(far.min(axis=0), 0.0), np.maximum(far.max(axis=0), 0.0)
            low, high = np.hypot(value - pair[:, 0], down), np.hypot(pair[:, 1] - value, up)
            return np.exp(np.column_stack([value - low, value + high]))

        return replace(
            held,
            pull_off_force=wider("pull_off_force"),
            work_to_pull_off=wider("work_to_pull_off"),
        )


def _start_doubt(tests: Contact, *, by: str, step: float = 1e-3) -> Array:
    """Return the standard deviation of log10 of the depths of starts, shape (n,)."""
    factors = np.power(10.0, step * np.arange(-1, 2))
    near = tests.deeper(np.repeat(factors[:, None], len(tests.rows), axis=1))
    said = near.said_of_start
    # the networks predict log10 of the radius
    told = np.array([near.started(x)[0] for x in said]) if by == "force" else said[..., 1]
    before, here, after = np.split(told, 3, axis=1)
    rise = np.abs((after - before).mean(axis=0)) / (2 * step)
    # if the given quantity hardly depends on the depth, the depth is undetermined
    return np.minimum(here.std(axis=0) / np.maximum(rise, 1e-30), 1.0)


def _by_name(names: tuple[str, ...], low: Array, high: Array) -> dict[str, tuple[float, float]]:
    return {n: (float(a), float(b)) for n, a, b in zip(names, low, high, strict=True)}
