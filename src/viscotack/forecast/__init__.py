"""Which answer to trust, and the answer at once."""

from .advice import Advice, Estimate, advise, threshold_contact_radius
from .answer import predict
from .prediction import Prediction, prediction_summary
from .table import predict_table

__all__ = [
    "Advice",
    "Estimate",
    "Prediction",
    "advise",
    "predict",
    "predict_table",
    "prediction_summary",
    "threshold_contact_radius",
]
