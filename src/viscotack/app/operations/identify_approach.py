"""The operation ``identify approach``: range of attraction from the forces before the contact."""

from typing import Any, ClassVar

from viscotack.errors import InputError

from .identify import Level, Radius
from .options import named, number
from .parts.record_words import read
from .parts.rig import Rig, refusals
from .parts.solid import solid_of
from .request import Answer, Caller


class IdentifyApproach(Rig):
    """Bound the range of attraction by the approach, before the jump into contact.

    Every cycle with an approach gives an upper bound of h0 and, where an attraction is seen before
    the jump-in, an interval. The compliance of the rig is that of its spring: it decides where the
    contact jumps. The work of adhesion lies between that of the jump-in and that of the pull-off,
    unless it is given. An interface whose fitted range (`viscotack identify rates`) exceeds the
    bound has a fitted length of the crack's zone, not a range of attraction.

    Example: viscotack identify approach sphere_*.csv --radius "7.5 um" --contact-modulus "1.9 MPa"
    --compliance "332 mm/N"
    """

    word: ClassVar = "identify approach"

    radius: Radius
    contact_modulus: float | None = number(
        'E0* of the relaxed solid, "1.9 MPa"; default: that of --material.', "Pa"
    )
    material: Any = named(
        "Passport or published name of the solid, instead of --contact-modulus; its modulus at "
        "once is the other limit."
    )
    work_of_adhesion: float | None = number(
        'Known work of adhesion, "50 mJ/m2"; default: between jump-in and pull-off.', "J/m^2"
    )
    level: Level = 0.9

    def answer(self, caller: Caller) -> Answer:
        """Bound the range by every approach."""
        from viscotack.identify.approach import identify_approaches
        from viscotack.model.materials.passport import Passport

        modulus, instantaneous = self.contact_modulus, None
        if (modulus is None) == (self.material is None):
            raise InputError("give either contact_modulus or material", field="contact_modulus")
        if modulus is None:
            solid = Passport.of(solid_of(self.material, caller)).material
            modulus = solid.contact_modulus
            instantaneous = modulus / solid.modulus_ratio
        survey = self.survey(caller)
        fits, refused = identify_approaches(
            survey.cycles,
            contact_modulus=modulus,
            instantaneous=instantaneous,
            **self.values("radius", "work_of_adhesion", "level"),
        )
        if not fits:
            raise InputError("; ".join(dict.fromkeys(refused)), field="files")
        return Answer(
            fits,
            data=lambda: {"approaches": [_record(fit) for fit in fits]},
            notes=(*refusals(survey), *(f"refused: {why}" for why in dict.fromkeys(refused))),
        )


def _record(fit: Any) -> dict[str, Any]:
    """Return the numbers of one approach."""
    interval = fit.equilibrium_gap
    names = ("bound_m", "level", "attraction_N", "noise_N", "jump_in_force_N", "step_m", "words")
    return read(fit, *names) | {
        "equilibrium_gap_m": fit.likely,
        "interval_m": None if interval is None else [interval.low, interval.high],
        "works_of_adhesion_J_m2": fit.works,
        "samples_during_jump": fit.during,
    }
