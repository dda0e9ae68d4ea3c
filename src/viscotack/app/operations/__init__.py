"""Operations: every task of a user, each declared once as a request for all front ends.

Every module of this folder has requests: pydantic models with a name (``word``), options, and a
method that returns an answer. `COMMANDS` lists them by name, so that a front end imports only what
it runs.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError

if TYPE_CHECKING:
    from .request import Answer, Request

__all__ = ["ask", "operation", "operations"]


@dataclass(frozen=True)
class Listed:
    """A command before its module is imported.

    Attributes
    ----------
    module : str
        Module of this folder that declares its request.
    summary : str
        First line of its help.
    indenter : str or None
        Of the problem that its flags state, "" for a file alone; None for a request of one command.
    """

    module: str
    summary: str
    indenter: str | None = None


# What a person does -> its commands.
SECTIONS: Mapping[str, Mapping[str, Listed]] = {
    "Model a contact": {
        "predict": Listed("predict", "Predict the pull-off force, with an interval."),
        "advise": Listed(
            "predict", "Determine the regime of a contact and the reliability of each method."
        ),
        "simulate sphere": Listed(
            "simulate", "Pull a rigid sphere off a soft viscoelastic half-space.", "sphere"
        ),
        "simulate punch": Listed(
            "simulate", "Pull a rigid flat punch off a soft viscoelastic layer.", "punch"
        ),
        "simulate profile": Listed(
            "simulate", "Pull a cone or another profile off a viscoelastic half-space.", "profile"
        ),
        "simulate disc": Listed(
            "simulate", "Pull a disc, the flat end of a cylinder, off a half-space.", "disc"
        ),
        "simulate case": Listed(
            "simulate", "Simulate the problem of a case file in SI, with any indenter.", ""
        ),
        "show": Listed("simulate", "Show a saved result."),
        "rough": Listed("rough", "Press a rough surface against a soft body and pull it off."),
        "uncertainty": Listed(
            "uncertainty", "Propagate uncertainties of inputs to the pull-off force."
        ),
        "theory jkr": Listed("theory_contacts", "Detachment of an elastic sphere (JKR)."),
        "theory maugis": Listed(
            "theory_contacts", "Detachment of an elastic sphere, forces of any range."
        ),
        "theory disc": Listed("theory_contacts", "Detachment of a disc (Kendall)."),
        "theory punch": Listed("theory_punch", "Flat punch on a layer: stress, or thickness."),
        "theory persson-brener": Listed("theory_cracks", "Surface energy of a moving crack."),
        "theory greenwood": Listed(
            "theory_cracks", "Surface energy of a moving crack with a cohesive zone."
        ),
        "theory steady-crack": Listed(
            "theory_cracks", "Surface energy of a steady crack with its whole traction law."
        ),
        "theory crack-contact": Listed(
            "theory_contacts", "Compute a contact history with the steady-crack contact model."
        ),
    },
    "Read measured data": {
        "material fit": Listed(
            "fit_material", "Fit a material to a DMA, relaxation or creep test."
        ),
        "material list": Listed("library", "List the published materials."),
        "material show": Listed("passports", "Show a material passport or a published material."),
        "material convert": Listed("passports", "Convert a passport."),
        "material export": Listed("passports", "Export a material for another program."),
        "test read": Listed("rig_tests", "Read tack tests or force curves."),
        "identify slow": Listed("identify", "Identify the work of adhesion from a slow test."),
        "identify rates": Listed(
            "identify", "Identify the interface from tests at several speeds."
        ),
        "identify edge": Listed(
            "identify",
            "Identify the plain edge law from pull-offs at several speeds, without a dynamic test.",
        ),
        "identify approach": Listed(
            "identify_approach", "Bound the range of attraction by the approach."
        ),
        "identify curves": Listed(
            "identify_curves", "Fit work of adhesion and modulus to every curve of a folder."
        ),
        "identify dwell": Listed("identify_dwell", "Identify the growth with contact time."),
        "forecast": Listed("forecast", "Forecast pull-off forces from a measured rate series."),
        "next-test": Listed("next_test", "Rank tests by how much each narrows a forecast."),
        "report": Listed("forecast", "Write a report of a rate series as a web page."),
    },
    "Design": {
        "design": Listed("design", "Find radius, preload, pads and speeds for wanted forces."),
        "array": Listed("array", "Pull an array of pads off."),
        "window": Listed("window", "Determine where a stamp picks an object and prints it."),
        "control": Listed("control", "Tabulate the force for a controller; release at a force."),
    },
    "Compute many cases": {
        "sweep": Listed("sweep", "Simulate variations of a problem, one row for each case."),
        "campaign inputs": Listed("campaign", "List the numbers of a problem that a plan can set."),
        "campaign plan": Listed("campaign", "Describe the cases of a plan without running it."),
        "campaign run": Listed("campaign", "Run the cases of a plan that have no result yet."),
        "campaign status": Listed("campaign", "Show the progress of a campaign."),
        "campaign merge": Listed("campaign", "Merge several campaigns into one."),
        "campaign export": Listed("campaign", "Export the results as a table."),
        "study": Listed("", "Run the operation of a study file with its options."),
    },
    "Serve other programs": {
        "app": Listed("", "Open the web page and the HTTP API."),
        "export contact": Listed("export_contact", "Write a contact for other simulators, in C."),
        "schema": Listed("schema", "Print the JSON schema of a problem."),
    },
}
COMMANDS = {name: each for commands in SECTIONS.values() for name, each in commands.items()}


def _word(name: str) -> str:
    """Return the request of a command: those of indenters have one."""
    return name if COMMANDS[name].indenter is None else name.partition(" ")[0]


OPERATIONS = {_word(name): each.module for name, each in COMMANDS.items() if each.module}


def operations() -> dict[str, "type[Request]"]:
    """Import and return all operations by name, sorted.

    Examples
    --------
    >>> "predict" in operations()
    True
    """
    return {word: operation(word) for word in sorted(OPERATIONS)}


def operation(word: str) -> "type[Request]":
    """Import and return the request of an operation.

    Parameters
    ----------
    word : str
        Name of the operation, such as "identify rates".

    Returns
    -------
    class
        A subclass of `Request`.

    Raises
    ------
    ValueError
        If no operation has this name.

    Examples
    --------
    >>> operation("predict").__name__
    'Predict'
    """
    if word not in OPERATIONS:
        raise InputError(f"unknown operation {word!r:.60}; known are {', '.join(OPERATIONS)}")
    module = import_module(f"{__name__}.{OPERATIONS[word]}")
    kinds = (each for each in vars(module).values() if isinstance(each, type))
    return next(kind for kind in kinds if vars(kind).get("word") == word)


def ask(word: str, /, **given: Any) -> "Answer":
    """Run an operation; the answer is the same as on the command line and over HTTP.

    Parameters
    ----------
    word : str
        Name of the operation, such as "identify rates".
    **given
        Options by name: numbers in SI, or text with units as on the command line; file names; a
        problem as an object, a case file or its tables; a passport as an object or a file.
        `also` is a sequence of user-defined classes.

    Returns
    -------
    Answer
        `found` contains the objects, `record()` returns plain data, `str()` is its text.

    Raises
    ------
    ValueError
        If an option is unknown, missing or invalid, or the operation has no answer.

    Examples
    --------
    >>> found = ask("theory maugis", tabor=1.0)
    >>> f"{found.record()['pull_off_force']:.4f}"
    '1.0548'
    """
    from .request import Caller, answered, request_of

    also = tuple(given.pop("also", ()))
    return answered(request_of(operation(word), given), Caller(also=also))
