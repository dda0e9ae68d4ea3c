"""The learning study: what is learned from, held out and compared."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import gamma

pytest.importorskip("sklearn", reason="comes with viscotack[replication]")
pytest.importorskip("xgboost", reason="comes with viscotack[replication]")

from research.replication.learning.features import (  # noqa: E402
    Descriptor,
    Target,
    crack_amplification,
    features,
    target,
)
from research.replication.learning.learners import (  # noqa: E402
    BOOSTING,
    FOREST,
    LEARNERS,
    LINEAR,
    NETWORK,
    TREE,
    trained,
)
from research.replication.learning.noise import label_noise  # noqa: E402
from research.replication.learning.splits import (  # noqa: E402
    band_split,
    group_split,
    grouped_splits,
    random_split,
    same_input,
    value_split,
)
from research.replication.learning.thesis import STATISTICS, TABLES  # noqa: E402
from research.replication.learning.trajectories import kept_sign, trajectories  # noqa: E402
from research.replication.learning.validation import Trial, r_squared, score  # noqa: E402
from research.replication.table import Detachments  # noqa: E402

from .rows import made_rows  # noqa: E402

# the descriptor


def test_the_two_descriptors_agree_at_the_tabor_number_of_the_fit():
    rows = made_rows()
    same = rows.tabor == 3.24
    found = [crack_amplification(rows, d) for d in tuple(Descriptor)[1:]]
    assert same.any()
    np.testing.assert_allclose(found[0][same], found[1][same], rtol=1e-12)
    assert np.all(found[0][~same] < found[1][~same])


def test_the_descriptor_tends_to_one_and_to_the_modulus_ratio():
    rows = made_rows(6)
    ends = []
    for rate in (1e-14, 1e25):
        values = {name: getattr(rows, name) for name in rows.__dataclass_fields__}
        moved = Detachments(**values | {"rate": np.full(6, rate)})
        ends.append(crack_amplification(moved, Descriptor.PUBLISHED))
    np.testing.assert_allclose(ends[0], 1, rtol=1e-5)
    np.testing.assert_allclose(ends[1] * rows.modulus_ratio, 1, rtol=1e-3)


def test_the_descriptor_solves_equation_5_1_as_printed():
    """Peer: the integral by quadrature and the root by bisection, in the rate of the authors."""
    rows = made_rows(6, seed=3)
    found = crack_amplification(rows, Descriptor.PUBLISHED)
    for k, n, rate, answer in zip(rows.modulus_ratio, rows.exponent, rows.rate, found, strict=True):
        v = 2.887 * (rate / (3.24 * np.pi ** (2 / 3))) ** 1.171

        def miss(g, k=k, n=n, v=v):
            def part(y):
                tau = np.exp(y)
                x = g / (2 * np.pi * v * tau)
                return tau**n * np.exp(-tau) / gamma(n) / (np.sqrt(1 + x**2) + x)

            integral = sum(
                quad(part, a, a + 5, epsabs=1e-13, epsrel=1e-10)[0] for a in range(-100, 5, 5)
            )
            return g * (1 - (1 - k) * integral) - 1

        assert answer == pytest.approx(brentq(miss, 1, 1 / k, xtol=1e-10), rel=1e-6)


def test_features_are_the_inputs_and_the_descriptor_as_it_is():
    rows = made_rows(10)
    X = features(rows, Descriptor.PUBLISHED)
    assert X.shape == (10, 6)
    np.testing.assert_array_equal(X[:, :5], features(rows, Descriptor.NONE))
    np.testing.assert_array_equal(X[:, 5], crack_amplification(rows, Descriptor.PUBLISHED))
    np.testing.assert_allclose(
        10 ** X[:, [0, 2, 3]],
        np.stack([rows.preload, rows.rate, rows.modulus_ratio], axis=1),
        rtol=1e-13,
    )


# what is held out


def test_every_row_is_held_out_once_and_never_learned_from_then():
    rows = made_rows()
    for split in grouped_splits(rows, seed=1):
        held_out = np.concatenate([held for _, held in split.folds()])
        assert sorted(held_out) == list(range(len(rows)))
        for train, held in split.folds():
            assert len(train) + len(held) == len(rows) and not set(train) & set(held)


def test_what_a_fold_holds_out_is_new_to_its_model():
    rows = made_rows()
    columns = {"k": rows.modulus_ratio, "n": rows.exponent, "mu": rows.tabor}
    splits = {split.name: split for split in grouped_splits(rows, seed=1)}
    for name, values in columns.items():
        for train, held in splits[f"a new {name}"].folds():
            assert len(set(values[held])) == 1 and not set(values[held]) & set(values[train])
    solids = list(zip(*columns.values(), strict=True))
    for train, held in splits["a new (mu, k, n)"].folds():
        assert not {solids[i] for i in held} & {solids[i] for i in train}


def test_repeated_inputs_stay_together():
    rows = made_rows(30)
    twice = rows.chosen(np.r_[np.arange(30), np.arange(30)])
    group = same_input(twice)
    np.testing.assert_array_equal(group[:30], group[30:])
    assert len(set(group)) == 30
    fold = group_split("a new input", group, seed=0).fold
    np.testing.assert_array_equal(fold[:30], fold[30:])
    assert not np.array_equal(random_split(60, 0).fold[:30], random_split(60, 0).fold[30:])


def test_values_that_are_almost_the_same_are_one():
    assert value_split("mu", np.array([3.19, 3.2, 3.24, 2.0])).labels == ("2", "3.19 to 3.24")


def test_bands_are_in_order_and_alike_in_size():
    values = np.random.default_rng(0).uniform(0, 5, 800)
    split = band_split("rate", values)
    assert np.bincount(split.fold).tolist() == [100] * 8
    tops = [values[split.fold == i].max() for i in range(8)]
    bottoms = [values[split.fold == i].min() for i in range(8)]
    assert all(top < bottom for top, bottom in zip(tops, bottoms[1:], strict=False))


# scores, sizes, noise


def test_r2_is_that_of_scikit_learn():
    from sklearn.metrics import r2_score

    rng = np.random.default_rng(2)
    true, found = rng.normal(size=(2, 50))
    assert r_squared(true, found) == pytest.approx(r2_score(true, found), rel=1e-13)


def test_a_score_is_that_of_scikit_learn_on_the_same_folds():
    from sklearn.linear_model import LinearRegression
    from sklearn.model_selection import KFold, cross_val_score

    rows = made_rows()
    found = score(rows, Trial(Target.FORCE, Descriptor.NONE, LINEAR), random_split(120, 42), seed=0)
    peer = -cross_val_score(
        LinearRegression(),
        features(rows, Descriptor.NONE),
        target(rows, Target.FORCE),
        cv=KFold(5, shuffle=True, random_state=42),
        scoring="neg_mean_squared_error",
    )
    np.testing.assert_allclose(found.mse, peer, rtol=1e-12)
    assert found.pooled_mse == pytest.approx(peer.mean(), rel=1e-12)


def test_a_model_of_the_truth_has_no_error():
    """Identity: the linear model is given a target that is linear in its inputs."""
    rows = made_rows()
    values = {name: getattr(rows, name) for name in rows.__dataclass_fields__}
    linear = Detachments(**values | {"pull_off_force": 3 * rows.rate**0.2 * rows.preload**0.1})
    trial = Trial(Target.FORCE, Descriptor.NONE, LINEAR)
    found = score(linear, trial, random_split(120, 0), seed=0)
    assert found.pooled_mse < 1e-24 and found.typical_error < 1e-11


def test_sizes_count_what_the_thesis_counts():
    rows = made_rows()
    X, y = features(rows, Descriptor.NONE), target(rows, Target.FORCE)
    model = {learner.name: trained(learner, X, y, seed=0, quick=True) for learner in LEARNERS}
    assert LINEAR.size(model[LINEAR.name]) == 6
    # each of 120 different rows has a leaf of its own
    assert TREE.size(model[TREE.name]) == 119
    assert FOREST.size(model[FOREST.name]) % 3 == 0
    assert 5 < BOOSTING.size(model[BOOSTING.name]) <= 5 * 64
    assert NETWORK.size(model[NETWORK.name]) == 5 * 8 + 8 + 8 * 8 + 8 + 8 + 1


def test_the_noise_of_labels_is_found_from_rows_that_repeat():
    """Peer: the standard deviation that was put in; 3000 degrees of freedom, 4 sigma."""
    rows = made_rows(1500)
    thrice = rows.chosen(np.tile(np.arange(1500), 3))
    noise = np.random.default_rng(5).normal(0, 0.01, 4500)
    values = {name: getattr(thrice, name) for name in rows.__dataclass_fields__}
    noisy = Detachments(**values | {"pull_off_force": thrice.pull_off_force * 10**noise})
    found = label_noise(noisy, Target.FORCE)
    assert found["floor_mse_1e-3"] == pytest.approx(0.1, rel=4 * (2 / 3000) ** 0.5)
    assert found["repeated_inputs"] == 1500 and found["share_of_rows_repeated"] == 1
    assert label_noise(noisy, Target.WORK)["floor_mse_1e-3"] == pytest.approx(0, abs=1e-20)


def test_without_trajectories_the_study_says_so():
    assert "no trajectories" in trajectories(made_rows(), seed=0, quick=True)["absent"]


def test_without_repeats_there_is_no_floor():
    found = label_noise(made_rows(), Target.FORCE)
    assert found["repeated_inputs"] == 0 and found["floor_mse_1e-3"] is None


def test_the_logarithm_that_keeps_the_sign_can_be_undone():
    y = np.array([-20.0, -2.0, -0.5, 0.0, 0.5, 2.0])
    x = kept_sign(y)
    assert np.all(np.diff(x) > 0)
    np.testing.assert_allclose(np.sign(x) * np.expm1(np.abs(x)), y, rtol=1e-14)


# the published rows


def test_the_published_columns_are_spread_as_table_a_1_says(published):
    """Peer: a part of the table, with Tabor numbers below those of the thesis among it."""
    for name, values in zip(STATISTICS, features(published, Descriptor.NONE).T, strict=True):
        mean, median, deviation, *_ = STATISTICS[name]
        assert np.mean(values) == pytest.approx(mean, abs=0.1 * deviation)
        assert np.median(values) == pytest.approx(median, abs=0.15 * deviation)
        assert np.std(values) == pytest.approx(deviation, rel=0.05)


def learned(rows, table, learner):
    """Return how well a learner does on random rows of what an entry of a table is of."""
    trial = Trial(table.target, table.descriptor, learner)
    return score(rows, trial, random_split(len(rows), 42), seed=42)


def met(rows, table, learner):
    """Hold the error and R2 of a learner to the entry of a table of the thesis."""
    found, thesis = learned(rows, table, learner), table.entries[learner.name]
    assert 1e3 * found.mse.mean() == pytest.approx(thesis.mse, abs=thesis.mse_spread)
    assert found.r2.mean() == pytest.approx(thesis.r2, abs=thesis.r2_spread)


@pytest.mark.parametrize("table", TABLES, ids=lambda t: t.number)
def test_linear_entries_of_the_tables_are_met_within_their_spread(published, table):
    """Peer: six or seven numbers are learned as well from a seventh of the thesis's rows."""
    met(published, table, LINEAR)


@pytest.mark.parametrize("table", TABLES, ids=lambda t: t.number)
def test_boosting_lies_between_its_entry_and_the_linear_one_on_few_rows(sample, table):
    """Peer: it needs the other rows, from which its entries are met."""
    found = learned(sample, table, BOOSTING)
    thesis, linear = (table.entries[learner.name] for learner in (BOOSTING, LINEAR))
    # 1.36, 0.55, 9.2 and 8.0 here, table by table; with all rows 0.16, 0.10, 3.8 and 3.7
    assert thesis.mse + thesis.mse_spread < 1e3 * found.mse.mean() < linear.mse / 4


@pytest.mark.outside
@pytest.mark.parametrize("table", TABLES, ids=lambda t: t.number)
def test_boosted_entries_of_the_tables_are_met_within_their_spread(whole, table):
    met(whole, table, BOOSTING)


def on_a_new_modulus_ratio(rows):
    """Return R2 of the boosted force on modulus ratios not seen, without and with the crack."""
    split = value_split("k", rows.modulus_ratio)
    return [
        score(rows, Trial(Target.FORCE, descriptor, BOOSTING), split, seed=42).pooled_r2
        for descriptor in (Descriptor.NONE, Descriptor.PUBLISHED)
    ]


def test_a_modulus_ratio_that_is_new_is_not_predicted_by_trees(published):
    plain, augmented = on_a_new_modulus_ratio(published)
    # -2.0 and -0.9; with all rows -1.2 and 0.25
    assert plain < -1
    assert plain < augmented < 0.6


@pytest.mark.outside
def test_the_crack_helps_trees_a_little_where_the_modulus_ratio_is_new(whole):
    _, augmented = on_a_new_modulus_ratio(whole)
    assert 0 < augmented < 0.6


def test_the_published_labels_disagree_by_a_per_cent(published):
    """Peer: their description gives 1.4 % at the 95th percentile and 19 % at worst."""
    found = label_noise(published, Target.FORCE)
    assert 0.005 < found["spread_95"] < 0.02
    assert found["spread_worst"] < 0.2


def test_the_authors_fed_the_amplification_itself_and_not_its_logarithm(published):
    """Peer: the linear entry of Table 5.2, which trees cannot tell."""
    thesis = TABLES[1].entries[LINEAR.name]
    X, y = features(published, Descriptor.PUBLISHED), target(published, Target.FORCE)
    errors = []
    for column in (X[:, 5], np.log10(X[:, 5])):
        Z, squares = np.column_stack([X[:, :5], column]), []
        for train, held in random_split(len(y), 42).folds():
            model = trained(LINEAR, Z[train], y[train], seed=0)
            squares.append(np.mean((y[held] - model.predict(Z[held])) ** 2))
        errors.append(1e3 * np.mean(squares))
    assert errors[0] == pytest.approx(thesis.mse, abs=thesis.mse_spread)
    assert errors[1] < thesis.mse - 1.5 * thesis.mse_spread
