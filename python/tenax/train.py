"""The network of ten taxels (Bamshad 2023): five classifiers compared, as figure 7 compares five; the better of network and linear model
rounded to the firmware's integers and written as its tables.

    python -m tenax.train out/array_dataset.csv                        # what `cargo tenax dataset` writes
    python -m tenax.train mine.csv --recipe r.toml --out out/train     # your own recordings: docs/array.md
    python -m tenax.train out/array_dataset.csv --ship .               # into this checkout's logic; then flash

Needs `pip install './python[train]'`. `out/train` gets `network.in` (Rust for the firmware), `network.json`, `model-card.md` and `report.json`.
Learned from the training part, chosen on the validation part; without parts, sessions are left out in turn. `--test` scores the test part, too.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import HistGradientBoostingClassifier, RandomForestClassifier
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import balanced_accuracy_score, roc_auc_score
from sklearn.model_selection import GroupKFold
from sklearn.neural_network import MLPClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC
from threadpoolctl import threadpool_limits

from . import MV, _native, labelled

Floats = NDArray[np.float32]
Rows = NDArray[Any]
Labels = NDArray[np.bool_]

INPUTS, UNITS = 112, (32, 16)
PASSES = 12
# From the last element's reading to the network's verdict.
DECIDED_S = 0.0025
# Covariances and spectra tell few objects apart rather than their sliding: they are scaled down beside variances and structure functions.
SHYNESS = 0.1
# Part of the steps of pours: the paper's 36 in 2800, less a fifth for sessions other than those that a threshold is chosen on.
FALSE_MAX = 0.8 * 36 / 2800
# Balanced accuracy by which the network must be better than the linear model, to be chosen.
BETTER = 0.005
# Of the 55 covariances, row by row of the upper triangle.
PAIRS = np.triu_indices(10)
# 0: variances and structure functions by kind, which hold for other objects, too.
KINDS = np.concatenate((np.where(PAIRS[0] == PAIRS[1], 0, 1), np.full(21, 2), np.full(36, 3)))


@dataclass(frozen=True)
class Recipe:
    """Lag of a difference and window of a covariance, readings; below a knee (samples^2) a feature is linear."""

    lag: int = 1
    window: int = 10
    covariance_knee: int = 128
    spectrum_knee: int = 2048
    structure_knee: int = 128


@dataclass
class Steps:
    """The features of a recording, a row a reading from the one on with which the windows are full, and where it slips."""

    session: str
    material: str
    part: Optional[str]
    pours: bool
    rows: NDArray[np.int16]
    slips: Labels
    recording: labelled.Recording
    # Readings before the first row.
    silent: int


@dataclass
class Network:
    """Weights and biases of three layers in single precision, for features as they are."""

    weights: Tuple[Floats, Floats, Floats]
    biases: Tuple[Floats, Floats, Floats]

    def activations(self, rows: Rows) -> Tuple[Floats, Floats, Floats]:
        """Of both hidden layers, and the logits."""
        parts = [self._activations(rows[n : n + 4096]) for n in range(0, len(rows), 4096)]
        seen, hidden, logits = (np.concatenate(each) for each in zip(*parts))
        return seen, hidden, logits[:, 0]

    def _activations(self, rows: Rows) -> List[Floats]:
        own: List[Floats] = [rows.astype(np.float32)]
        for weights, bias in zip(self.weights, self.biases):
            # Term by term, so that not even the last bit depends on the machine.
            sums = np.zeros((len(rows), len(bias)), np.float32)
            for column, factor in zip(own[-1].T, weights.T):
                sums += column[:, None] * factor
            own.append(np.maximum(sums + bias, 0) if len(own) < 3 else sums + bias)
        return own[1:]

    def logits(self, rows: Rows) -> NDArray[np.float64]:
        return self.activations(rows)[2].astype(np.float64)


def features(samples: NDArray[np.uint16], recipe: Recipe) -> Tuple[NDArray[np.int16], Labels]:
    """The network's inputs, and the readings in which the windows are full."""
    volts = samples.astype(np.float64) * MV / 1000
    knees = (recipe.covariance_knee, recipe.spectrum_knee, recipe.structure_knee)
    rows = _native.features(volts, 80, (recipe.lag, *knees))
    known = np.asarray(rows.any(axis=1))
    if recipe.window != 10:
        rows[:, :55] = covariances(samples, recipe)
        known[: recipe.lag + recipe.window - 1] = False
    return rows, known


def covariances(samples: NDArray[np.uint16], recipe: Recipe) -> NDArray[np.int16]:
    """As the firmware's, over any window."""
    readings = samples.astype(np.int64)
    most = 1 << (int(math.sqrt((2**31 - 1) / recipe.window)).bit_length() - 1)
    changes = np.zeros_like(readings)
    changes[recipe.lag :] = np.clip(readings[recipe.lag :] - readings[: -recipe.lag], -most, most - 1)
    sums = np.cumsum(changes[:, PAIRS[0]] * changes[:, PAIRS[1]], axis=0)
    sums[recipe.window :] -= sums[: -recipe.window].copy()
    knee = np.float32(recipe.covariance_knee)
    # The bits of a float are its logarithm: logic/src/array/logarithm.rs.
    logarithms = ((np.abs(sums).astype(np.float32) + knee).view(np.int32) - knee.view(np.int32)) >> 14
    return np.asarray(np.sign(sums) * logarithms, np.int16)


def scale_of(rows: Rows) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean and factor of each feature. Features of a kind share theirs, so that a quiet taxel is not amplified; one that hardly ever changes
    has none, for it would keep a random weight."""
    mean, deviation = rows.mean(axis=0, dtype=np.float64), rows.std(axis=0, dtype=np.float64)
    shared = np.array([deviation[KINDS == kind].mean() for kind in range(4)])[KINDS]
    factor = np.where((KINDS == 0) | (KINDS == 3), 1.0, SHYNESS) / np.maximum(shared, 1.0)
    return mean, np.where(deviation < 1, 0.0, factor)


def as_network(weights: Sequence[Rows], biases: Sequence[Rows], scale: Tuple[Rows, Rows]) -> Network:
    """A network that takes scaled features, as one that takes them as they are."""
    first = weights[0] * scale[1]
    own = (first, *weights[1:])
    single = [np.ascontiguousarray(each, np.float32) for each in (*own, biases[0] - first @ scale[0], *biases[1:])]
    return Network((single[0], single[1], single[2]), (single[3], single[4], single[5]))


def linear(weights: Rows, bias: float, scale: Tuple[Rows, Rows]) -> Network:
    """A linear model as a network: two units of each layer carry its logit and the negative."""
    first, second, last = np.zeros((UNITS[0], INPUTS)), np.zeros((UNITS[1], UNITS[0])), np.zeros((1, UNITS[1]))
    first[0], first[1] = weights, -weights
    second[0, 0] = second[1, 1] = last[0, 0] = 1.0
    last[0, 1] = -1.0
    first_bias = np.zeros(UNITS[0])
    first_bias[0], first_bias[1] = bias, -bias
    return as_network((first, second, last), (first_bias, np.zeros(UNITS[1]), np.zeros(1)), scale)


def _alike(slips: Labels) -> NDArray[np.float64]:
    """Weights with which both kinds of rows count alike, 1 in the mean."""
    shares = np.array([np.mean(~slips), np.mean(slips)])
    return np.asarray(0.5 / np.maximum(shares, 1e-12)[slips.astype(int)], np.float64)


def learn(rows: Rows, slips: Labels, balanced: bool, seed: int) -> Iterator[Network]:
    """The linear model, then the network after each pass. `balanced`: slip and no slip count alike, otherwise each row does."""
    if not slips.any() or slips.all():
        raise ValueError(f"of {len(slips)} steps to learn from {np.count_nonzero(slips)} slip: both kinds are needed")
    scale = scale_of(rows)
    x = ((rows - scale[0]) * scale[1]).astype(np.float32)
    weights = _alike(slips) if balanced else np.ones(len(slips))
    # The penalty grows with the data: more of it are no more objects.
    model = LogisticRegression(C=1 / (4e-3 * weights.sum()), max_iter=1000).fit(x, slips, weights)
    yield linear(model.coef_[0], float(model.intercept_[0]), scale)
    network = MLPClassifier(UNITS, batch_size=min(256, len(x)), alpha=1e-2, max_iter=1, warm_start=True, random_state=np.random.RandomState(seed))
    for done in range(PASSES):
        network.set_params(learning_rate_init=1e-3 * (1 + math.cos(math.pi * done / PASSES)))
        with warnings.catch_warnings():
            # A pass is one round, and does not converge.
            warnings.simplefilter("ignore", ConvergenceWarning)
            network.fit(x, slips, weights)
        yield as_network([own.T for own in network.coefs_], network.intercepts_, scale)


def threshold(logits: Rows, slips: Labels, false_max: float = 1.0) -> float:
    """The logit above which slip has the best balanced accuracy, with at most this part of the steps false."""
    order = np.argsort(logits, kind="stable")
    values, ordered = logits[order], slips[order]
    missed = np.concatenate(([0], np.cumsum(ordered)))
    false = np.count_nonzero(~slips) - np.concatenate(([0], np.cumsum(~ordered)))
    costs = missed / max(missed[-1], 1) + false / max(false[0], 1)
    edges = np.concatenate(([True], values[1:] > values[:-1], [True]))
    best = int(np.argmin(np.where(edges & (false <= false_max * len(slips)), costs, np.inf)))
    around = np.concatenate(([values[0] - 1], values, [values[-1] + 1]))
    return float(around[best] + around[best + 1]) / 2


@dataclass
class Choice:
    """A network, its balanced accuracy on sessions that it has not seen (0 to 1), and slope and intercept that turn its logit into log-odds."""

    name: str
    network: Network
    unseen: float
    threshold: float
    calibration: Tuple[float, float]


def folds(sequences: Sequence[Steps]) -> Iterator[Tuple[List[Steps], List[Steps]]]:
    """To learn from, and to choose by."""
    parts = [[own for own in sequences if own.part == part] for part in ("train", "validation", None)]
    if parts[0]:
        if not parts[1]:
            raise ValueError("the data set has a training part but no validation part to choose by")
        pours = [own for own in parts[1] if own.pours]
        yield parts[0], pours or parts[1]
        return
    sessions = [own.session for own in parts[2]]
    if len(set(sessions)) < 2:
        raise ValueError("all recordings are of one session or object: at least two are needed; name their column as [recordings] session")
    for learned, judged in GroupKFold(min(len(set(sessions)), 5)).split(sessions, groups=sessions):
        yield [parts[2][n] for n in learned], [parts[2][n] for n in judged]


def rows_of(sequences: Sequence[Steps]) -> Tuple[NDArray[np.int16], Labels]:
    return np.concatenate([own.rows for own in sequences]), np.concatenate([own.slips for own in sequences])


def choose(sequences: Sequence[Steps], seed: int) -> Tuple[Choice, Choice]:
    """The linear model, and the network after as many passes as are best on sessions that it has not seen; both learned from all."""
    has_parts = any(own.part for own in sequences)
    # What each fold's networks say of the steps that they have not seen, by passes.
    heard: List[List[Tuple[NDArray[np.float64], Labels]]] = [[] for _ in range(PASSES + 1)]
    for learned, judged in folds(sequences):
        unseen, truth = rows_of(judged)
        networks = list(learn(*rows_of(learned), not has_parts, seed))
        for passes, network in enumerate(networks):
            heard[passes].append((network.logits(unseen), truth))
    if not has_parts:
        networks = list(learn(*rows_of(sequences), True, seed))
    choices = []
    for passes, (network, own) in enumerate(zip(networks, heard)):
        logits, truth = (np.concatenate(each) for each in zip(*own))
        at = threshold(logits, truth, FALSE_MAX if has_parts else 1.0)
        unseen_part = float(np.mean([balanced_accuracy_score(slips, each > at) for each, slips in own]))
        spread = max(float(logits.std()), 1e-12)
        odds = LogisticRegression(C=1e9).fit(logits[:, None] / spread, truth)
        calibration = (float(odds.coef_[0, 0]) / spread, float(odds.intercept_[0]))
        choices.append(Choice(f"network, {passes} passes" if passes else "linear model", network, unseen_part, at, calibration))
    return choices[0], max(choices[1:], key=lambda own: own.unseen)


def _rounded(values: Rows) -> NDArray[np.int64]:
    """To nearest, halves away from 0."""
    size = np.abs(np.asarray(values, np.float64))
    whole = np.floor(size)
    return np.asarray(np.sign(values) * (whole + (size - whole >= 0.5)), np.int64)


def _nearest(value: float) -> int:
    return int(_rounded(np.array(value)))


def _integers_of_one(weights: Floats) -> float:
    """For a weight of 1: as many as 8 bits allow, and as few as keep every sum of full-scale inputs in 32 bits, a quarter left to the bias."""
    by_sum = 0.75 * 65536 / max(float(np.cumsum(np.abs(weights.astype(np.float64)), axis=1)[:, -1].max()), 1e-12)
    return min(by_sum, 127 / max(float(np.abs(weights).max()), 1e-12))


def _shift(scale: float, largest: np.float32) -> Tuple[int, float]:
    """Bits that sums are shifted by so that no activation of 1.5 times the largest saturates, and the scale afterwards."""
    bits = math.ceil(math.log2(max(float(largest * np.float32(1.5)) * scale / 32767, 1.0)))
    return bits, scale / (1 << bits)


def equalised(network: Network) -> Network:
    """A ReLU does not mind a unit's scale: the first layer's weights and those behind it become equally large (Nagel et al. 2019), so that
    rounding costs no unit more than another."""
    first, second, last = network.weights
    before, after = np.abs(first).max(axis=1), np.abs(second).max(axis=0)
    scale, used = np.ones(len(before), np.float32), (before > 0) & (after > 0)
    scale[used] = np.sqrt(after[used] / before[used])
    return Network((first * scale[:, None], second / scale, last), (network.biases[0] * scale, *network.biases[1:]))


def quantise(network: Network, rows: Rows, calibration: Tuple[float, float], at: float) -> Dict[str, Any]:
    """The firmware's integers: 8-bit weights, 16-bit activations, whose size is measured on `rows`."""
    network = equalised(network)
    seen, hidden, _ = network.activations(rows)
    per_one = [_integers_of_one(own) for own in network.weights]
    first_shift, first_scale = _shift(per_one[0], seen.max())
    second_shift, second_scale = _shift(per_one[1] * first_scale, hidden.max())
    per_logit = per_one[2] * second_scale
    weights = [_rounded(own.astype(np.float64) * per).tolist() for own, per in zip(network.weights, per_one)]
    sums = zip(network.biases, (per_one[0], per_one[1] * first_scale, per_logit), (first_shift, second_shift, 0))
    # Half a step more, so that the shift rounds to nearest.
    biases = [(_rounded(bias.astype(np.float64) * per) + (1 << shift >> 1)).tolist() for bias, per, shift in sums]
    slope, intercept = calibration
    per_nat = per_logit / slope
    permille = _nearest(1000 / (1 + math.exp(-(slope * at + intercept))))
    return {
        "first": [weights[0], biases[0], first_shift],
        "second": [weights[1], biases[1], second_shift],
        # The intercept is part of the bias: a logit of 0 is even odds.
        "last": [weights[2][0], _nearest(biases[2][0] + intercept * per_nat)],
        "logit_per_nat": _nearest(per_nat),
        "on_permille": permille,
        "off_permille": permille,
    }


def judge(saved: Dict[str, Any], rows: Rows) -> NDArray[np.float64]:
    """Log-odds of slip, as the firmware's integers have them."""
    own = rows.astype(np.int64)
    for weights, bias, shift in (saved["first"], saved["second"]):
        own = np.clip((own @ np.array(weights).T + bias) >> shift, 0, 32767)
    weights, bias = saved["last"]
    return np.asarray((own @ np.array(weights) + bias) / saved["logit_per_nat"], np.float64)


def rust(saved: Dict[str, Any], about: str) -> str:
    """The expression that `logic/src/array/shipped.rs` includes: a row of weights a line."""
    layers = ""
    for name, weights, bias, shift in (
        ("first", *saved["first"]), ("second", *saved["second"]), ("last", [saved["last"][0]], [saved["last"][1]], 0),
    ):
        rows = "".join(f"                {row},\n" for row in weights)
        layers += f"        {name}: layer::<{len(weights[0])}, {len(weights)}>(\n            [\n{rows}            ],\n"
        layers += f"            {bias},\n            {shift},\n        ),\n"
    return f"""// Generated by `python -m tenax.train`; not to be edited.
// {about}
Model {{
    preprocessor: PreprocessorConfig {{
        covariance_knee: {saved["covariance_knee"]},
        spectrum_knee: {saved["spectrum_knee"]},
        structure_knee: {saved["structure_knee"]},
        lag: {saved["lag"]},
        ..PreprocessorConfig::DEFAULT
    }},
    network: Mlp {{
{layers}    }},
    judgement: Judgement {{
        logit_per_nat: {saved["logit_per_nat"]},
        on_permille: {saved["on_permille"]},
        off_permille: {saved["off_permille"]},
    }},
}}
"""


def score(values: Rows, slips: Labels, false_max: float) -> Dict[str, float]:
    """At the best threshold with at most this part of the steps false, and over all thresholds."""
    says = values > threshold(values, slips, false_max)
    return {"balanced": float(balanced_accuracy_score(slips, says)), "auc": float(roc_auc_score(slips, values))}


def classifiers(rows: Rows, slips: Labels, unseen: Rows, seed: int) -> Iterator[Tuple[str, Rows]]:
    """What five, learned from rows, say of unseen ones: larger is slip. scikit-learn has no LSTM: forest and boosting stand in the place of the paper's two."""
    five: Dict[str, Any] = {
        "SVM": SVC(random_state=seed),
        "linear model": LogisticRegression(max_iter=1000),
        "random forest": RandomForestClassifier(100, min_samples_leaf=5, random_state=seed),
        "boosting": HistGradientBoostingClassifier(random_state=seed),
        "MLP": MLPClassifier(UNITS, early_stopping=True, random_state=seed),
    }
    for name, own in five.items():
        model = make_pipeline(StandardScaler(), own)
        model.fit(rows, slips, **{f"{type(own).__name__.lower()}__sample_weight": _alike(slips)})
        yield name, model.decision_function(unseen) if hasattr(model, "decision_function") else model.predict_proba(unseen)[:, 1]


def card(report: Dict[str, Any]) -> str:
    """A model card, Markdown. Its first line says whether the linear model is as good."""
    data, recipe, own = report["data"], report["features"], report["choice"]
    few = "" if report["has_parts"] else " (sessions left out in turn)"
    few_false = f" with at most {100 * FALSE_MAX:.1f} % false steps" if report["has_parts"] else ""
    lines = [
        f"**{report['verdict']}**", "", "# Model card: slip from ten normal forces", "", "Written by `python -m tenax.train`.", "", "| | |", "|---|---|",
        f"| learned | `{data['file']}`, SHA-256 `{data['sha256']}`: {data['recordings']} recordings of {data['sessions']} sessions or objects, "
        f"{data['steps']} steps, {data['slip_steps']} of them slip |",
        f"| seed | {report['seed']} |",
        f"| features | 55 covariances (lag {recipe['lag']}, window {recipe['window']}, knee {recipe['covariance_knee']}), 21 spectral bins (knee "
        f"{recipe['spectrum_knee']}), 36 structure functions (knee {recipe['structure_knee']}) |",
        f"| tables | {INPUTS}-{UNITS[0]}-{UNITS[1]}-1, 8-bit weights, 16-bit activations: the {own['name']} |",
        f"| chosen | balanced accuracy before rounding {own['unseen']:.3f} on sessions it had not seen{few} |",
        f"| calibration | log-odds = {own['calibration'][0]:.4f} logit {own['calibration'][1]:+.4f}; single threshold: {report['threshold_permille']} per mille |",
        "", "## Sessions not seen", "", f"At the best threshold{few_false}; the five have learned at most {report['at_most']} rows.", "", "| | balanced accuracy | AUC |",
        "|---|---|---|",
    ]
    lines += [f"| {name} | {score['balanced']:.3f} | {score['auc']:.3f} |" for name, score in report["scores"].items()]
    if report["edges"]:
        edges = report["edges"]
        pour = edges["pour"]
        lines += [
            "", f"**Two thresholds**: slip begins at a confidence of {edges['on_permille']} and ends below {edges['off_permille']} per mille: the best balanced accuracy "
            f"in pours with at most 60 false alarms an hour and 29 false steps in 2800. Balanced {pour['balanced']:.3f}; {pour['missed_2800']:.0f} steps missed and "
            f"{pour['false_2800']:.0f} false in 2800; {100 * (pour['caught_50ms'] or 0):.0f} % of {pour['slips']} slips caught within 50 ms; "
            f"{pour['false_per_hour']:.0f} false alarms an hour.",
        ]
    lines += [
        "", "## Limits", "", "It knows the sensor, the materials and the ways of slipping of the data above, and no others. A report ends late, since its windows still hold "
        "the slip. Confidence is calibrated for the data's share of slip. `--test` scores it on data that nothing was chosen by.", "",
    ]
    return "\n".join(lines)


def steps_of(path: Path, recipe_name: Optional[str], test: bool = False) -> Tuple[List[Steps], Recipe, Tuple[float, float]]:
    """Features of a labelled file, less its test part, or of that alone; and the least and the most noise of the arrays that are learned from."""
    given = labelled.recipe_of(path, recipe_name)
    recordings = [own for own in labelled.read(path, given) if (own.part == "test") == test]
    recipe, all_steps = Recipe(**given["features"]), []
    for own in recordings:
        rows, known = features(own.samples, recipe)
        all_steps.append(Steps(own.session, own.material, own.part, own.task == "pour", rows[known], own.slips[known], own, int(np.argmax(known))))
    if not any(len(own.rows) for own in all_steps):
        raise ValueError(f"{path}: every recording is shorter than the windows, or none is there")
    # What is disturbed has more noise than its array, and no slip to be learned in it.
    noise = [own.noise() for own in recordings if own.part in (None, "train") and own.task != "disturb"]
    return all_steps, recipe, (min(noise, default=0.0), max(noise, default=0.0))


def edges(saved: Dict[str, Any], pours: Sequence[Steps], on: NDArray[np.int64], off: NDArray[np.int64]) -> Tuple[Dict[str, Any], ...]:
    """Scores of pours where slip begins at a confidence and ends below another, per mille: of each pair, and of those that are quiet the best."""
    counts, hours = np.zeros((2, 2, len(on))), 0.0
    alarms, caught, slips = np.zeros(len(on)), np.zeros(len(on)), 0
    for own in pours:
        confidence = 1000 / (1 + np.exp(-judge(saved, own.rows)))
        said = np.zeros((len(own.slips) + 1, len(on)), np.bool_)
        for n, value in enumerate(confidence):
            said[n + 1] = value >= np.where(said[n], off, on)
        begins, said = said[1:] & ~said[:-1], said[1:]
        for is_slip in (0, 1):
            own_steps = said[own.slips == is_slip]
            counts[is_slip] += ((~own_steps).sum(axis=0), own_steps.sum(axis=0))
        silent = own.recording.slips[: own.silent]
        counts[:, 0] += np.array([np.count_nonzero(~silent), np.count_nonzero(silent)])[:, None]
        hours += (len(own.slips) + own.silent) / labelled.RATE_HZ / 3600
        at_s = own.recording.first_s + (own.silent + np.arange(len(begins))) / labelled.RATE_HZ + DECIDED_S
        moves = [span for span in own.recording.spans if span.macro_s is not None]
        alarms += begins[~np.any([span.owns(at_s) for span in moves], axis=0)].sum(axis=0) if moves else begins.sum(axis=0)
        for span in moves:
            if not span.meant:
                slips += 1
                caught += begins[span.owns(at_s) & (at_s <= (span.macro_s or 0) + labelled.CAUGHT_S)].any(axis=0)
    every, right = counts.sum(axis=(0, 1)), counts[[0, 1], [0, 1]] / np.maximum(counts.sum(axis=1), 1)
    table = {
        "balanced": right.mean(axis=0), "missed_2800": 2800 * counts[1, 0] / every, "false_2800": 2800 * counts[0, 1] / every,
        "caught_50ms": caught / max(slips, 1), "false_per_hour": alarms / max(hours, 1e-12),
    }
    return tuple({"slips": slips, **{name: float(values[n]) for name, values in table.items()}} for n in range(len(on)))


def best_edges(saved: Dict[str, Any], pours: Sequence[Steps]) -> Optional[Dict[str, Any]]:
    """The two thresholds with the best balanced accuracy that are quiet enough, and their scores."""
    on, off = (each.ravel() for each in np.meshgrid(np.arange(500, 1000, 25), np.arange(50, 1000, 25), indexing="ij"))
    on, off = on[off <= on], off[off <= on]
    scored = [(pour["balanced"], n, pour) for n, pour in enumerate(edges(saved, pours, on, off))] if pours else []
    quiet = [own for own in scored if own[2]["false_per_hour"] <= 60 and own[2]["false_2800"] <= 29]
    if not quiet:
        return None
    _, n, pour = max(quiet, key=lambda own: own[:2])
    return {"on_permille": int(on[n]), "off_permille": int(off[n]), "pour": pour}


def _where(one: Choice, other: Choice, judged: Sequence[Steps]) -> str:
    """The materials on which the first has the better balanced accuracy."""
    better = []
    for material in sorted({own.material for own in judged}):
        rows, slips = rows_of([own for own in judged if own.material == material])
        right = [balanced_accuracy_score(slips, each.network.logits(rows) > each.threshold) for each in (one, other)]
        if right[0] > right[1]:
            better.append(material)
    return ", ".join(better) or "no material"


def tested(path: Path, recipe_name: Optional[str], saved: Dict[str, Any]) -> Dict[str, Any]:
    """Scores of the test part, which nothing was chosen by, at the thresholds that are written."""
    sequences, _, _ = steps_of(path, recipe_name, test=True)
    rows, slips = rows_of(sequences)
    odds = judge(saved, rows)
    says = odds >= -math.log(1000 / saved["on_permille"] - 1)
    pours = [own for own in sequences if own.pours]
    on, off = (np.array([saved[name]]) for name in ("on_permille", "off_permille"))
    return {
        "balanced": float(balanced_accuracy_score(slips, says)), "auc": float(roc_auc_score(slips, odds)),
        "pour": edges(saved, pours, on, off)[0] if pours else None,
    }


def train(path: Path, recipe_name: Optional[str] = None, seed: int = 1, at_most: int = 20_000) -> Tuple[Dict[str, Any], Dict[str, Any]]:
    """The tables of the better of network and linear model (network.json), and a report. Fails if there is too little to choose by."""
    # The matrices are small: a second thread costs more than it saves, and with one nothing depends on which is first.
    with threadpool_limits(1):
        return _train(path, recipe_name, seed, at_most)


def _train(path: Path, recipe_name: Optional[str], seed: int, at_most: int) -> Tuple[Dict[str, Any], Dict[str, Any]]:
    sequences, recipe, noise = steps_of(path, recipe_name)
    learned = [own for own in sequences if own.part in (None, "train")]
    rows, slips = rows_of(learned)
    has_parts = any(own.part for own in sequences)
    linear_model, network = choose(sequences, seed)
    as_good = linear_model.unseen > network.unseen - BETTER
    own = linear_model if as_good else network
    first, judged = next(folds(sequences))
    told = f"balanced accuracy {linear_model.unseen:.3f} and {network.unseen:.3f} in sessions that neither has seen"
    if has_parts:
        told += f"; it is better on {_where(linear_model, network, judged)}"
    verdict = f"The linear model is {'as good as the network; it is what was written' if as_good else 'not as good as the network'}: {told}."
    sha256 = hashlib.sha256(path.read_bytes()).hexdigest()
    saved = {
        "sha256": sha256, "lag": recipe.lag, "window": recipe.window, "covariance_knee": recipe.covariance_knee, "spectrum_knee": recipe.spectrum_knee,
        "structure_knee": recipe.structure_knee, **quantise(own.network, rows, own.calibration, own.threshold), "noise_samples": list(noise),
    }
    permille = saved["on_permille"]
    pours = [own for own in sequences if own.part == "validation" and own.pours]
    two = best_edges(saved, pours) if recipe.window == 10 else None
    if two:
        saved.update(on_permille=two["on_permille"], off_permille=two["off_permille"])
    (some, which), (unseen, truth) = rows_of(first), rows_of(judged)
    if len(some) > at_most:
        kept = np.random.default_rng(seed).choice(len(some), at_most, replace=False)
        some, which = some[kept], which[kept]
    false_max = FALSE_MAX if has_parts else 1.0
    scores = {name: score(values, truth, false_max) for name, values in classifiers(some, which, unseen, seed)}
    # Without parts these have learned the rows that they are scored on.
    seen = "all rows" if has_parts else "of rows that it has learned"
    for name, model in (("linear model", linear_model), ("network", network)):
        scores[f"{name}, {seen}"] = score(model.network.logits(unseen), truth, false_max)
    scores[f"as written, {seen}"] = score(judge(saved, unseen), truth, false_max)
    data = {
        "file": path.name, "sha256": sha256, "recordings": len(learned), "steps": len(slips), "slip_steps": int(np.count_nonzero(slips)),
        "sessions": len({each.session for each in learned}),
    }
    choice = {"name": own.name, "unseen": own.unseen, "threshold": own.threshold, "calibration": own.calibration}
    report = {
        "verdict": verdict, "seed": seed, "data": data, "features": vars(recipe), "has_parts": has_parts, "at_most": at_most, "choice": choice,
        "threshold_permille": permille, "edges": two, "scores": scores,
    }
    return saved, report


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m tenax.train", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", type=Path, help="labelled recordings (CSV)")
    parser.add_argument("--recipe", help="how to read them: a recipe file, or the name of one (default: by the file's name)")
    parser.add_argument("--out", type=Path, default=Path("out/train"), help="folder for what is written")
    parser.add_argument("--seed", type=int, default=1, help="of the initial weights and of the training order")
    parser.add_argument("--rows", type=int, default=20_000, help="rows that the five classifiers learn from, at most")
    parser.add_argument("--test", action="store_true", help="also score the test part: once, when everything is chosen")
    parser.add_argument("--ship", type=Path, metavar="CHECKOUT", help="also replace logic/src/array/network.in of this checkout")
    asked = parser.parse_args(arguments)
    try:
        saved, report = train(asked.dataset, asked.recipe, asked.seed, asked.rows)
        if asked.test:
            report["test"] = tested(asked.dataset, asked.recipe, saved)
    except (OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    if asked.ship and saved["window"] != 10:
        parser.error("the firmware has another window")
    data = report["data"]
    tables = rust(saved, f"Learned from `{data['file']}` (SHA-256 {data['sha256']}), seed {report['seed']}; docs/array.md says how it is judged.")
    asked.out.mkdir(parents=True, exist_ok=True)
    (asked.out / "network.in").write_text(tables)
    (asked.out / "network.json").write_text(json.dumps(saved, separators=(",", ":")))
    (asked.out / "model-card.md").write_text(card(report))
    (asked.out / "report.json").write_text(json.dumps(report, indent=2))
    if asked.ship:
        (asked.ship / "logic/src/array/network.in").write_text(tables)
    print(report["verdict"])
    for name, score in report["scores"].items():
        print(f"{name:<42}balanced accuracy {score['balanced']:.3f}, AUC {score['auc']:.3f}")
    if asked.test:
        print(f"test part: {report['test']}")
    print(f"{asked.out}: network.in, network.json, model-card.md, report.json")
    return 0


if __name__ == "__main__":
    sys.exit(main())
