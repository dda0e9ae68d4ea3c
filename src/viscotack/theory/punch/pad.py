r"""The pad: layer, punch and interface, as input of the theories in this room.

Its thickness b is a separate argument, because the theories vary or solve for it. So is its
viscoelastic solid, which matters only at the edges, as a
:class:`viscotack.theory.crack.law.CrackLaw`; a pad contains the contact modulus, rubbery if speed
matters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from viscotack.errors import InputError
from viscotack.model.geometry import Base
from viscotack.theory._checks import Number, Values, positive
from viscotack.theory.crack import CrackLaw
from viscotack.theory.crack.law import Material

from . import crossover, laws


@dataclass(frozen=True, kw_only=True)
class Pad:
    r"""A layer under a rigid flat punch, plane strain, of any thickness.

    Parameters
    ----------
    half_width : float
        Half width a of the punch [m].
    contact_modulus : float
        E* = E/(1 - nu^2) of the layer [Pa].
    work_of_adhesion : float
        :math:`\Delta\gamma_0` [J/m^2].
    strength : float
        Strength of the interface :math:`\sigma_0` [Pa].
    base : Frictionless or Bonded
        Boundary condition of the layer on its base.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> f"a0 = {pad.fracture_length * 1e6:.1f} um, {pad.elastic_stress(1e-4) / 1e3:.1f} kPa"
    'a0 = 31.4 um, 32.2 kPa'
    """

    half_width: float
    contact_modulus: float
    work_of_adhesion: float
    strength: float
    base: Base

    def __post_init__(self) -> None:
        for name in ("half_width", "contact_modulus", "work_of_adhesion", "strength"):
            object.__setattr__(self, name, float(positive(**{name: getattr(self, name)})))
        if not isinstance(self.base, Base):
            raise InputError(
                f"base must be Frictionless() or Bonded(poisson_ratio=...), got {self.base!r}"
            )

    @property
    def fracture_length(self) -> float:
        """Return a0 [m], :func:`viscotack.theory.punch.laws.fracture_length`."""
        return float(
            laws.fracture_length(
                contact_modulus=self.contact_modulus,
                work_of_adhesion=self.work_of_adhesion,
                strength=self.strength,
            )
        )

    def elastic_stress(self, thickness: Values) -> Number:
        """Return the exact mean pull-off stress [Pa] at thicknesses [m], without strength limit."""
        return crossover.pull_off_stress(thickness, **self._elastic())

    def elastic_depth(self, thickness: Values) -> Number:
        """Return the exact depth of pull-off [m] at thicknesses [m], negative."""
        return crossover.depth_at_pull_off(thickness, **self._elastic())

    def elastic_thickness(self, stress: Values) -> Number:
        """Return the thickness [m] of the exact elastic layer with a given pull-off stress [Pa]."""
        return crossover.thickness(stress, **self._elastic())

    def crack_law(self, theory: str, *, material: Material) -> CrackLaw:
        """Return the crack law of the edges of this pad, with its rubbery ``contact_modulus``.

        Its length is the cohesive zone of :mod:`viscotack.theory.crack.greenwood`, a0/2, or a0 for
        "persson-brener" (appendix II of the thesis).
        """
        length = self.fracture_length / (2 if theory == "greenwood" else 1)
        return CrackLaw(theory=theory, material=material, tip_length=length)

    def _elastic(self) -> dict[str, Any]:
        return {
            "half_width": self.half_width,
            "contact_modulus": self.contact_modulus,
            "work_of_adhesion": self.work_of_adhesion,
            "base": self.base,
        }
