r"""Internal variables of the solid: one displacement field per retardation mode.

The creep compliance is a short sum of exponentials (:class:`viscotack.model.materials.Modes`), so
that the hereditary integral of Eq. 4.15 needs no stored history. Let e(t) be the displacement that
the present pressure would cause in the relaxed solid. Mode j follows :math:`\tau_j \dot d_j = e -
d_j`, and the surface displacement is :math:`u = c\, e + \sum_j w_j d_j` (c: instantaneous
compliance). If e is linear over a step dt, with :math:`x = dt/\tau` and :math:`\varphi =
(1-e^{-x})/x`, then exactly

.. math:: d^+ = e^{-x} d + (\varphi - e^{-x})\, e + (1-\varphi)\, e^+ .

The state variables are displacements, not stresses. Ahead of the crack, inside the contact, they
are smooth, so remeshing around the moving edge adds almost no error, even for k = 1e-4. The forces
z conjugate to d obey the same recursion and are stored for the energy balance. The heat of mode j
in a step is :math:`w_j \int (e-d_j)\cdot(F-z_j)\,dt/\tau_j`, integrated exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.model.materials import Modes


@dataclass(frozen=True, eq=False)
class Step:
    """The recursion of all modes for one step length.

    Attributes
    ----------
    compliance : float
        Displacement at the end of the step per unit of e there: c + sum w (1 - phi).
    decay : ndarray, shape (M,)
        exp(-x) of each mode.
    drive : ndarray, shape (M, 2)
        phi - exp(-x) and 1 - phi of each mode.
    curvature : float
        Displacement per unit deviation of e from linear; used by the step-size control.
    """

    weights: npt.NDArray
    times: npt.NDArray
    length: float
    compliance: float
    decay: npt.NDArray
    drive: npt.NDArray
    curvature: float

    def heat(self, start: npt.NDArray, mixed: npt.NDArray, ramp: float) -> npt.NDArray:
        """Return the heat of each mode from the products of fields over the nodes.

        With y = e - d and f = F - z at the start of the step, and the changes de and dF in it, they
        are y f and y dF, shape (M,), and de dF.
        """
        x = self.length / self.times
        # y(s) = y exp(-s) + v (1 - exp(-s)) with v = de/x; integrals of the three products
        one, two = -np.expm1(-x), -np.expm1(-2 * x) / 2
        # the last integral loses digits by cancellation for short steps; use its series there
        series = x**3 / 3 - x**4 / 4 + 7 * x**5 / 60
        square = np.where(x < 1e-3, series, x - one - one**2 / 2)
        return self.weights * (start * two + mixed / x * one**2 + ramp / x**2 * square)


def step(modes: Modes, length: float) -> Step:
    """Return the recursion for a step of this length [time units of the modes]."""
    w, tau = np.asarray(modes.weights), np.asarray(modes.times)
    x = length / tau
    decay = np.exp(-x)
    phi = -np.expm1(-x) / x
    return Step(
        weights=w,
        times=tau,
        length=length,
        compliance=modes.instantaneous + float(w @ (1 - phi)),
        decay=decay,
        drive=np.array([phi - decay, 1 - phi]).T,
        # A parabola of unit height over the step adds x/6 to a slow mode and 1/x to a fast one.
        curvature=float(w @ (x / (6 + x * x))),
    )


@dataclass(frozen=True, eq=False)
class Memory:
    """Displacement d and force z of every mode, shape (M, N)."""

    displacement: npt.NDArray
    force: npt.NDArray

    def inherited(self, s: Step, e: npt.NDArray) -> npt.NDArray:
        """Return the displacement at the end of a step due to the loading history alone."""
        return (s.weights * s.decay) @ self.displacement + float(s.weights @ s.drive[:, 0]) * e

    def advanced(self, s: Step, e: npt.NDArray, e1: npt.NDArray, F: npt.NDArray, F1: npt.NDArray):
        """Return the memory after a step in which e and F changed linearly to e1 and F1."""

        def recur(field: npt.NDArray, first: npt.NDArray, last: npt.NDArray) -> npt.NDArray:
            return s.decay[:, None] * field + s.drive @ np.array([first, last])

        return Memory(recur(self.displacement, e, e1), recur(self.force, F, F1))

    def heat(self, s: Step, e: npt.NDArray, e1: npt.NDArray, F: npt.NDArray, F1: npt.NDArray):
        """Return the heat dissipated by each mode in that step, shape (M,) [dg beta^2]."""
        y, f = e - self.displacement, F - self.force
        start, mixed = np.einsum("ij,ij->i", y, f), y @ (F1 - F)
        return s.heat(start, mixed, float((e1 - e) @ (F1 - F)))

    def stored(self, weights: npt.NDArray) -> float:
        """Return the elastic energy in the springs of the modes [dg beta^2]."""
        return 0.5 * float(weights @ np.einsum("ij,ij->i", self.displacement, self.force))
