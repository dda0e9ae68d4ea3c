"""Operations: every task of a user, each declared once as a request for all front ends.

Every module of this folder has requests: pydantic models with a name (``word``), options, and a
method that returns an answer. `COMMANDS` lists them by name, so that a front end imports only what
it runs.
"""

from collections.abc import Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError

if TYPE_CHECKING:
    from .request import Answer, Request

__all__ = ["ask", "operation", "operations"]


# What a person does -> its commands: module of this folder that declares the request of each, ""
# without one, and the first line of its help.
SECTIONS: Mapping[str, Mapping[str, tuple[str, str]]] = {
    "Model a contact": {
        "predict": ("predict", "Predict the pull-off force, with an interval."),
        "advise": ("predict", "State the regime of a contact and what each method is worth."),
        "simulate": ("simulate", "Pull a sphere, punch, profile or disc off a soft body."),
        "show": ("simulate", "Show a saved result."),
        "rough": ("rough", "Press a rough surface against a soft body and pull it off."),
        "uncertainty": ("uncertainty", "Propagate uncertainties of inputs to the pull-off force."),
        "theory jkr": ("theory", "Detachment of an elastic sphere (JKR)."),
        "theory maugis": ("theory", "Detachment of an elastic sphere (Maugis)."),
        "theory disc": ("theory", "Detachment of a disc (Kendall)."),
        "theory punch": ("theory", "Flat punch on a layer: stress, or thickness."),
        "theory persson-brener": ("theory", "Surface energy of a moving crack."),
        "theory greenwood": ("theory", "Surface energy of a crack with a cohesive zone."),
        "theory steady-crack": ("theory", "Surface energy of a crack, any traction law."),
        "theory crack-contact": ("theory", "Contact history by the steady-crack model."),
    },
    "Read measured data": {
        "material fit": ("material", "Fit a material to a DMA, relaxation or creep test."),
        "material list": ("material", "List the published materials."),
        "material show": ("material", "Show a material passport or a published material."),
        "material convert": ("material", "Convert a passport."),
        "material export": ("material", "Export a material for another program."),
        "test read": ("rig_tests", "Read tack tests or force curves."),
        "identify slow": ("identify", "Identify the work of adhesion from a slow test."),
        "identify rates": ("identify", "Identify the interface from tests at several speeds."),
        "identify edge": ("identify", "Identify the plain edge law, without a dynamic test."),
        "identify approach": ("identify", "Bound the range by the approach."),
        "identify curves": ("identify", "Fit work and modulus to every curve of a folder."),
        "identify dwell": ("identify", "Identify the growth with contact time."),
        "forecast": ("forecast", "Forecast pull-off forces from a measured rate series."),
        "next-test": ("forecast", "Rank tests by how much each narrows a forecast."),
        "report": ("forecast", "Write a report of a rate series as a web page."),
    },
    "Design": {
        "design": ("design", "Find radius, preload, pads and speeds for wanted forces."),
        "array": ("design", "Pull an array of pads off."),
        "window": ("design", "Determine where a stamp picks an object and prints it."),
        "control": ("control", "Tabulate the force for a controller; release at a force."),
    },
    "Compute many cases": {
        "sweep": ("sweep", "Simulate variations of a problem, one row for each case."),
        "campaign inputs": ("campaign", "List the numbers of a problem that a plan can set."),
        "campaign plan": ("campaign", "Describe the cases of a plan without running it."),
        "campaign run": ("campaign", "Run the cases of a plan that have no result yet."),
        "campaign status": ("campaign", "Show the progress of a campaign."),
        "campaign merge": ("campaign", "Merge several campaigns into one."),
        "campaign export": ("campaign", "Export the results as a table."),
        "study": ("", "Run the operation of a study file with its options."),
    },
    "Serve other programs": {
        "app": ("", "Open the web page and the HTTP API."),
        "export contact": ("control", "Write a contact for other simulators, in C."),
        "schema": ("control", "Print the JSON schema of a problem."),
    },
}
COMMANDS = {name: each for commands in SECTIONS.values() for name, each in commands.items()}


OPERATIONS = {name: module for name, (module, _) in COMMANDS.items() if module}


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
