"""Operations: declared once, and answered alike by every door."""

import random
import shutil
from pathlib import Path

import pytest

from doors import OF_THE_SHELL, Http, Question, through_all
from viscotack.operations import operation
from viscotack.operations.declare.cards import (
    Choice,
    File,
    Folder,
    Known,
    Named,
    Number,
    Switch,
    Whole,
)
from viscotack.operations.declare.options import options
from viscotack.operations.declare.statement import Stated

ROOT = Path(__file__).parents[1]
FILES = [
    *(ROOT / "examples").glob("from_*/*.csv"),
    *(ROOT / "examples").glob("from_toml/*.toml"),
]
SPHERE = {
    "indenter": "sphere",
    "tabor": 3.24,
    "modulus_ratio": 0.1,
    "exponent": 0.8,
    "preload": 73.0,
    "rate": 316.23,
}
PUNCH = {
    "indenter": "punch",
    "size": 64.85,
    "thickness": 3.24,
    "cohesion": 0.05,
    "modulus_ratio": 0.1,
    "preload": 1.0,
    "rate": 10.0,
}
LENS = ["lens_1_um_s.csv", "lens_30_um_s.csv", "lens_1000_um_s.csv"]
# A question of each operation that is answered soon, from which others are drawn.
ASKED = {
    "advise": [{"problem": SPHERE}, {"problem": "lens.toml"}],
    "predict": [{"problem": SPHERE}, {"problem": PUNCH}, {"problem": "lens.toml"}],
    "simulate": [{"problem": SPHERE | {"preload": 1.0}, "accuracy": 0.02, "until": "pull-off"}],
    "test read": [{"files": ["lens_1_um_s.csv"]}, {"files": LENS}],
    "identify slow": [{"files": ["lens_slow.csv"], "radius": "5.19 mm", "model": ["jkr"]}],
    "material list": [{}],
}
# Drawn no more often than once: they take seconds.
SLOW = ("identify rates", "forecast", "report", "simulate")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Work in a folder with the files of the examples."""
    for file in FILES:
        shutil.copy(file, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def http():
    client = Http()
    yield client
    client.close()


def agree(question, found):
    """Compare what doors tell: records to the last digit, refusals to the letter."""
    first = found["Python"]
    for door, other in found.items():
        if other.refused.strip() and any(words in other.refused for words in OF_THE_SHELL):
            assert first.refused, f"{door} refuses {question}: {other.refused}"
            continue
        if "was sent with the request" in other.refused:
            # a file that is not there: HTTP looks for it among those that were sent, and at once
            assert first.refused, f"{door} refuses {question}: {other.refused}"
            continue
        assert other.record == first.record, f"{door}: {question}: {other} and {first}"
        assert other.refused == first.refused, f"{door}: {question}: {other} and {first}"


def drawn(luck):
    """Draw an operation, its options and their values, some of them wrong."""
    word = luck.choice([each for each in ASKED if each not in SLOW])
    given = dict(luck.choice(ASKED[word]))
    known = options(operation(word))
    for option in luck.sample(known, min(len(known), luck.choice([0, 1, 1, 2, 3]))):
        if isinstance(option.card, Stated):
            given[option.name] = of_problem(luck, given[option.name])
        elif not isinstance(option.card, Folder):
            value = value_of(luck, option)
            given[option.name] = [value] if option.many else value
            if getattr(option.card, "elsewhere", False):
                given.pop("problem")  # on the command line it stands in its place
    if luck.random() < 0.05:
        given[luck.choice(["acuracy", "radious", "x"])] = "1"
    if luck.random() < 0.05 and given:
        given.pop(luck.choice(list(given)))
    return Question(word, given)


def of_problem(luck, stated):
    """Change a number of a problem, or name what is not there."""
    if isinstance(stated, str):
        return luck.choice([stated, "nothing.toml", "pad.toml", "cone.toml", "lens_slow.csv"])
    name = luck.choice([each for each in stated if each != "indenter"])
    return stated | {name: luck.choice([0.5, 2.0, 10.0, -1.0, 1e-9]) * stated[name]}


def value_of(luck, option):
    """Draw a value for an option: right, out of range, or none at all."""
    card = option.card
    if isinstance(card, Switch):
        return luck.choice([True, False])
    if getattr(card, "elsewhere", False):
        return luck.choice(["lens_slow.csv", "nothing.csv"])
    if luck.random() < 0.15:
        return luck.choice(["foo", "-1", "5 kg", "1e400", "../../etc/passwd", "{radius}"])
    if isinstance(card, Known | Number):
        low, high = (x if x is not None else y for x, y in ((card.least, 1e-3), (card.most, 10.0)))
        number = float(f"{low * (high / low) ** luck.random():.3g}") if low > 0 else 0.5
        # without a unit a number is in SI, where it is no text
        plain = [number, repr(number)] if card.unit == "1" or card.bare else []
        return luck.choice([f"{number!r} {card.unit}" if card.unit != "1" else number, *plain])
    if isinstance(card, Whole):
        return luck.choice([1, 2, "1", 100])
    if isinstance(card, Choice):
        return luck.choice(card.choices)
    if isinstance(card, File):
        return luck.choice(["lens_slow.csv", "pdms_dma.csv", "nothing.csv", "lens.toml"])
    if isinstance(card, Named):
        return luck.choice(["pdms-10-1", "nothing.toml", "lens.toml"])
    return luck.choice(["mN", "um", "s", "csv", "1"])


@pytest.mark.parametrize("seed", range(20))
def test_all_doors_answer_drawn_questions_alike(seed, folder, http):
    luck = random.Random(seed)
    for _ in range(10):
        question = drawn(luck)
        agree(question, through_all(question, http))
