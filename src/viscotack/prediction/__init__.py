"""Predictions and their validity: surrogates, theories and the simulation, and their choice."""

from .advice import Advice, advise
from .cautions import cautions_on
from .closed_forms import Estimate
from .predict import predict
from .prediction import Prediction, prediction_summary
from .table import predict_table

__all__ = [
    "Advice",
    "Estimate",
    "Prediction",
    "advise",
    "cautions_on",
    "predict",
    "predict_table",
    "prediction_summary",
]
