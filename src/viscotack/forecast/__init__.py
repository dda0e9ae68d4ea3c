"""Which answer to trust, and the answer at once."""

from .advice import Advice, Estimate, advise, threshold_contact_radius
from .answer import predict
from .by_crack import CrackContact, crack_contact
from .prediction import OutOfRange, Prediction, prediction_summary
from .table import predict_table

__all__ = [
    "Advice",
    "CrackContact",
    "Estimate",
    "OutOfRange",
    "Prediction",
    "advise",
    "crack_contact",
    "predict",
    "predict_table",
    "prediction_summary",
    "threshold_contact_radius",
]
