"""Export a surrogate as one ONNX file, for MATLAB, C++ and controllers.

The file computes everything that a surrogate does, in double
precision: limits, networks, curves and intervals. It accepts rows outside the ranges; the output
``inside`` marks them.
"""

import os
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.model.problem.outputs import REVOLUTION
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.physics import SphereContact
from viscotack.result.curve import POINTS
from viscotack.version import __version__

from .graph import IR_VERSION, OPSET, Graph

CONFIDENCE = 0.9
_FORCE, _WORK = (
    REVOLUTION.observables[name].unit.text for name in ("pull_off_force", "work_to_pull_off")
)
_LENGTH, _RADIUS = (REVOLUTION.series[name].unit.text for name in ("depth", "contact_radius"))
INPUTS = {
    "tabor": "Tabor number (R dg0^2/(E0*^2 h0^3))^(1/3)",
    "modulus_ratio": "rubbery over glassy modulus",
    "exponent": "exponent of the power law by retardation",
    "preload": f"depth of the relaxed start [{_LENGTH}]",
    "rate": f"retraction speed [{_LENGTH}/tau0]",
}
# By name: columns, and description.
OUTPUTS = {
    "pull_off_force": ((), f"pull-off force [{_FORCE}], positive"),
    "work_to_pull_off": ((), f"work to pull-off [{_WORK}]"),
    "force_interval": ((2,), f"between which the simulated pull-off force is [{_FORCE}]"),
    "work_interval": ((2,), f"between which the simulated work to pull-off is [{_WORK}]"),
    "inside": ((5,), "which inputs are in the range learned from, in their order"),
    "doubtful": ((2,), "whether force and work are not certain and should not be used"),
    "force_slopes": ((5,), "derivatives of ln pull-off force by ln of the inputs, in their order"),
    "work_slopes": ((5,), "derivatives of ln work to pull-off by ln of the inputs"),
    "curve_depth": ((POINTS,), f"depth from start to pull-off [{_LENGTH}]"),
    "curve_force": ((POINTS,), f"force at these depths [{_FORCE}], compression positive"),
    "curve_contact_radius": ((POINTS,), f"contact radius at these depths [{_RADIUS}]"),
    "curve_band": (
        (),
        "how far forces in tension are off, over the pull-off force, at the same travel from zero "
        "force or from a start in tension",
    ),
    "travel_interval": ((2,), "from a pressed start to zero force, over what the curve has"),
}

_MASKS = ("inside", "doubtful")


def export(surrogate: Surrogate, path: str | os.PathLike[str]) -> None:
    """Write a surrogate as an ONNX file.

    Its input is `groups`, shape (n, 5), in the order of ``INPUTS``; its outputs are those of
    ``OUTPUTS``, of shape (n,) or (n, columns), intervals at a confidence of 0.9. Units, ranges,
    version and licence are in the file.

    Only surrogates of a sphere on power laws can be exported.
    """
    try:
        import onnx
    except ImportError:
        raise ModuleNotFoundError(
            "the export needs onnx; install it with: python -m pip install onnx"
        ) from None
    if surrogate.contact is not SphereContact:
        raise InputError(
            "only surrogates of a sphere on power laws can be exported, got one of the contact "
            f"{surrogate.contact.name!r}"
        )
    graph = Graph()
    row = np.sqrt([low * high for low, high in surrogate.limits.values()])
    for name, found in outputs(surrogate, graph.input("groups", row[None])).items():
        graph.named(found, name)
    helper, double, truth = onnx.helper, onnx.TensorProto.DOUBLE, onnx.TensorProto.BOOL
    words = "one case a row: " + "; ".join(f"{n}, {text}" for n, text in INPUTS.items())
    model = helper.make_model(
        helper.make_graph(
            graph.nodes,
            "viscotack",
            [helper.make_tensor_value_info("groups", double, ["n", len(INPUTS)], words)],
            [
                helper.make_tensor_value_info(
                    name, truth if name in _MASKS else double, ["n", *columns], text
                )
                for name, (columns, text) in OUTPUTS.items()
            ],
            graph.constants,
        ),
        opset_imports=[helper.make_opsetid("", OPSET)],
        ir_version=IR_VERSION,
        producer_name="viscotack",
        producer_version=__version__,
        doc_string="Detachment of a sphere on a power-law solid by retardation: Lennard-Jones "
        "traction, relaxed start, constant retraction speed. Dimensionless.",
    )
    helper.set_model_props(model, _facts(surrogate))
    onnx.checker.check_model(model, full_check=True)
    write_whole(path, model.SerializeToString())


def outputs(surrogate: Surrogate, groups: Any) -> dict[str, Any]:
    """Return what a surrogate says of groups, traced or of NumPy, by name."""
    answers = surrogate.evaluate(groups)
    between = surrogate.intervals(groups, answers, confidence=CONFIDENCE)
    curves = surrogate.curves(groups, answers)
    force_slopes, work_slopes = surrogate.slopes(groups)
    return {
        "pull_off_force": answers.pull_off_force,
        "work_to_pull_off": answers.work_to_pull_off,
        "force_interval": between.pull_off_force,
        "work_interval": between.work_to_pull_off,
        "inside": surrogate.inside(groups),
        "doubtful": surrogate.doubtful(groups, answers),
        "force_slopes": force_slopes,
        "work_slopes": work_slopes,
        "curve_depth": curves.depth,
        "curve_force": curves.force,
        "curve_contact_radius": curves.contact_radius,
        "curve_band": between.curve,
        "travel_interval": between.travel,
    }


def _facts(surrogate: Surrogate) -> dict[str, str]:
    """Return metadata for the reader of the file."""
    facts = {"version": __version__, "license": "MIT", "confidence": f"{CONFIDENCE:g}"}
    for name, text in INPUTS.items():
        low, high = surrogate.limits[name]
        facts[f"input.{name}"] = f"{text}, {low:g} to {high:g}"
    return facts | {f"output.{name}": text for name, (_, text) in OUTPUTS.items()}
