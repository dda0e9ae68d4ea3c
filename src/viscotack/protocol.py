"""What the machine does: a relaxed start, then a motion.

Depth is positive into the solid, force positive in compression. The three starts are statements
about one number. In a :class:`~viscotack.problem.Problem` the number is in SI; in
:class:`~viscotack.problem.Groups` it is in the dimensionless unit named there.
"""

from dataclasses import dataclass

from .units import finite, positive


@dataclass(frozen=True)
class AtDepth:
    """Start relaxed at a depth, on the branch in contact.

    Parameters
    ----------
    depth : float
        Depth of the sphere below the undeformed surface [m; h_0 when dimensionless]. Positive into
        the solid; a negative one exists while adhesion holds the contact.
    """

    depth: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "depth", finite("depth", self.depth, "m"))


@dataclass(frozen=True)
class AtForce:
    """Start relaxed under a force, on the branch of the larger radius, which a dead load keeps.

    Parameters
    ----------
    force : float
        Force [N; 1.5 pi R Delta-gamma_0 when dimensionless], positive in compression. A negative
        one exists down to the elastic pull-off force.
    """

    force: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", finite("force", self.force, "N"))


@dataclass(frozen=True)
class AtRadius:
    """Start relaxed at a contact radius.

    Parameters
    ----------
    contact_radius : float
        Radius of the edge, where the gap is that of peak tension
        [m; (pi R^2 Delta-gamma_0/E_0*)^(1/3) when dimensionless]; positive.
    """

    contact_radius: float

    def __post_init__(self) -> None:
        radius = positive("contact_radius", self.contact_radius, "m")
        object.__setattr__(self, "contact_radius", radius)


Start = AtDepth | AtForce | AtRadius


@dataclass(frozen=True)
class Apart:
    """Start out of contact and at rest.

    Parameters
    ----------
    gap : float
        Smallest gap between the undeformed surfaces [m; h_0 when dimensionless]; positive. Forces
        of finite range act there already: a few h_0 are needed to be out of contact, and more the
        softer the solid is; the search says so where contact is all there is.
    """

    gap: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "gap", positive("gap", self.gap, "m"))


@dataclass(frozen=True)
class Retraction:
    """Pull away at a constant speed from a relaxed start.

    Parameters
    ----------
    start : AtDepth, AtForce or AtRadius
        The relaxed state before the motion.
    speed : float
        Retraction speed [m/s]; positive. The depth falls at this rate.

    Examples
    --------
    >>> Retraction(start=AtForce(force=1.5e-3), speed=100e-6)
    Retraction(start=AtForce(force=0.0015), speed=0.0001)
    """

    start: Start
    speed: float

    def __post_init__(self) -> None:
        if not isinstance(self.start, Start):
            raise ValueError(
                f"start must be AtDepth, AtForce or AtRadius, got {self.start!r}; "
                "for example AtForce(force=1.5e-3)"
            )
        object.__setattr__(self, "speed", positive("speed", self.speed, "m/s"))
