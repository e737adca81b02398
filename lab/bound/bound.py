"""How much the drawn array signals tell, whatever it costs: float models on far more features than the firmware has room for.

    python3 -m venv /tmp/bound && /tmp/bound/bin/pip install -r train/bound/requirements.txt
    cargo tenax dataset --sessions 96
    /tmp/bound/bin/python train/bound/bound.py out/array_dataset.csv

Learns from the training part, scores pours of the validation part, and never looks at the test part. A few minutes a core.
Caught and false alarms are counted as bench/src/scorer.rs defines them; the verdict is taken to fall as the step is read.
"""

import csv
import sys

import lightgbm
import numpy as np
from sklearn.metrics import roc_auc_score
from sklearn.neural_network import MLPClassifier

READY = 40
ALONG = np.tile(np.linspace(-1.0, 1.0, 5), 2)
DIAGONAL = ALONG * np.repeat([-1.0, 1.0], 5)
UPPER = np.triu_indices(10)


def read(path):
    """Recordings of the training and validation parts."""
    recordings = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if row["split"] == "test":
                continue
            own = recordings.setdefault(
                row["recording"], {"part": row["split"], "task": row["task"], "t": [], "y": [], "x": [], "slips": []}
            )
            own["t"].append(float(row["t_s"]))
            own["y"].append(row["label"] == "1")
            own["x"].append([float(row[f"a{n}"]) for n in range(1, 11)])
            for slip in filter(None, row["slips"].split(";")):
                micro, macro, end, _ = slip.rstrip("!").split("/")
                if macro:
                    own["slips"].append((float(micro), float(macro), float(end) if end else np.inf))
    for own in recordings.values():
        for key in "tyx":
            own[key] = np.array(own[key])
    return recordings


def trailing(values, window):
    """Sums over the last `window` rows."""
    sums = np.vstack([np.zeros((1, values.shape[1])), np.cumsum(values, 0)])
    ends = np.arange(1, len(values) + 1)
    return sums[ends] - sums[np.maximum(ends - window, 0)]


def delayed(values, steps):
    return np.vstack([np.zeros((steps, values.shape[1])), values[: len(values) - steps]])


def size(energy):
    return np.log(energy + 0.05)


def change(x, lag):
    changes = np.zeros_like(x)
    changes[lag:] = x[lag:] - x[:-lag]
    return changes


def quiet(x, window=16, leak=1 / 400):
    """Each element's quiet noise: the least mean square of its changes so far, slowly forgotten."""
    changes = change(x, 1)
    energy = trailing((changes - changes.mean(1, keepdims=True)) ** 2, window) / window
    energy[: window + 8] = energy[window + 8]
    least = energy[0]
    out = np.empty_like(energy)
    for n, now in enumerate(energy):
        least = np.minimum(least * (1 + leak), now)
        out[n] = least
    return out + 0.3


def firmware(x):
    """The firmware's 112: covariance, spectrum, structure functions."""
    changes = change(x, 1)
    covariance = trailing(changes[:, UPPER[0]] * changes[:, UPPER[1]], 10)
    columns = [np.sign(covariance) * np.log2(1 + np.abs(covariance) / 128)]
    sums = np.concatenate([np.zeros(39), x.sum(1) - x[0].sum()])
    turns = np.exp(-2j * np.pi * np.outer(np.arange(21), np.arange(40)) / 40)
    power = np.abs(np.lib.stride_tricks.sliding_window_view(sums, 40) @ turns.T) ** 2
    columns.append(np.log2(1 + power / 2048))
    return np.hstack(columns + [structure(x)])


def structure(x):
    """Its structure functions alone."""
    columns = []
    for lag in (1, 2, 4, 8, 16, 32):
        changes = change(x, lag)
        energy = 10 * ((changes - changes.mean(1, keepdims=True)) ** 2).sum(1, keepdims=True)
        for begin, end in ((0, 1), (1, 2), (2, 4), (4, 8), (8, 16), (16, 32)):
            span = end - begin
            columns.append(np.log2(1 + delayed(trailing(energy, span), begin) / (128 * span)))
    columns.append(np.log2(quiet(x).mean(1, keepdims=True)))
    return np.hstack(columns)


def rich(x):
    """All that was thought of: six lags, eight windows, elements in units of their own quiet noise, those that move most, what they
    do together, along the pad and across its diagonal, the load and its tilt."""
    still = quiet(x)
    mean = still.mean(1, keepdims=True)
    columns = [np.log(mean)]
    for lag in (1, 2, 4, 8, 16, 32):
        changes = change(x, lag)
        together = changes.sum(1, keepdims=True)
        apart = changes - together / 10
        along, across = (apart @ ALONG)[:, None] / 5**0.5, (apart @ DIAGONAL)[:, None] / 5**0.5
        together = together / 10**0.5
        columns += [own / np.sqrt(mean) for own in (along, across, together)]
        energy = apart**2 / still
        for window in (1, 2, 3, 4, 6, 8, 16, 32):
            mean_of = lambda values: trailing(values, window) / window
            each = mean_of(energy)
            columns += [size(each.mean(1, keepdims=True)), size(mean_of(together**2 / mean))]
            if window in (1, 4, 16):
                columns.append(size(-np.sort(-each, 1)[:, [0, 1, 2, 4, 7]]))
                columns += [size(mean_of(own**2 / mean)) for own in (along, across)]
        for window in (4, 8, 16):
            columns.append(delayed(size(trailing(energy, window).mean(1, keepdims=True) / window), window))
    load = x.sum(1, keepdims=True)
    above = np.maximum(load - load[:20].mean() + 200, 50)
    return np.hstack(columns + [load, (x @ ALONG)[:, None] / above])


def raw(x, frames=12):
    """The last readings themselves, in units of their quiet noise, against the mean of those before."""
    still, sums = quiet(x), np.vstack([np.zeros((1, 10)), np.cumsum(x, 0)])
    ends = np.arange(1, len(x) + 1)
    until, since = np.maximum(ends - 12, 1), np.maximum(ends - 28, 0)
    rest = (sums[until] - sums[since]) / np.maximum(until - since, 1)[:, None]
    values = np.hstack([(delayed(x, n) - rest) / np.sqrt(still) for n in range(frames)])
    return np.sign(values) * np.log1p(np.abs(values))


def pours(recordings, logits, threshold):
    """Balanced accuracy, missed and false in 2800, part caught, false alarms an hour."""
    right = np.zeros(2)
    of = np.zeros(2)
    caught = count = alarms = 0
    hours = 0.0
    for name, own in recordings.items():
        said = logits[name] >= threshold
        said[:READY] = False
        for slip in (False, True):
            of[int(slip)] += (own["y"] == slip).sum()
            right[int(slip)] += ((own["y"] == slip) & (said == slip)).sum()
        begins = own["t"][1:][said[1:] & ~said[:-1]]
        hours += own["t"][-1] / 3600
        for micro, macro, end in own["slips"]:
            count += 1
            belongs = begins[(begins >= micro) & (begins <= end + 0.05)]
            caught += len(belongs) > 0 and belongs[0] <= macro + 0.05
        outside = [at for at in begins if not any(micro <= at <= end + 0.05 for micro, _, end in own["slips"])]
        alarms += len(outside)
    steps = of.sum()
    missed, false = 2800 * (of[1] - right[1]) / steps, 2800 * (of[0] - right[0]) / steps
    return {"balanced": (right / of).mean(), "missed": missed, "false": false, "caught": caught / count, "hour": alarms / hours}


def report(name, recordings, logits):
    own = {key: value for key, value in recordings.items() if value["part"] == "validation" and value["task"] == "pour"}
    scores = np.concatenate([logits[key][READY:] for key in own])
    labels = np.concatenate([own[key]["y"][READY:] for key in own])
    quantiles = np.concatenate([np.linspace(0.5, 0.9, 9), np.linspace(0.91, 0.999, 40), [0.9993, 0.9996]])
    rows = [pours(own, logits, np.quantile(scores, q)) for q in quantiles]
    best = max(rows, key=lambda row: row["balanced"])
    paper = max((row for row in rows if row["false"] <= 36), key=lambda row: row["balanced"])
    text = f"| {name} | {roc_auc_score(labels, scores):.3f} | {best['balanced']:.3f} | {paper['balanced']:.3f}, {paper['missed']:.0f} |"
    for limit in (60, 20):
        calm = max((row for row in rows if row["hour"] <= limit), key=lambda row: row["caught"])
        text += f" {calm['balanced']:.3f}, {100 * calm['caught']:.0f} % |"
    print(text, flush=True)


def main():
    recordings = read(sys.argv[1])
    rng = np.random.default_rng(1)
    # Half of the steps without slip are enough.
    keeps = {
        name: own["y"] | (rng.random(len(own["y"])) < 0.5) for name, own in recordings.items() if own["part"] == "train"
    }
    for keep in keeps.values():
        keep[:READY] = False
    labels = np.concatenate([recordings[name]["y"][keep] for name, keep in keeps.items()])
    print("| features, model | AUC | best balanced | at 36 false in 2800: balanced, missed | at 60 an hour: balanced, caught | at 20 |")
    print("|---|---|---|---|---|---|")
    own = {name: own for name, own in recordings.items() if own["part"] == "validation" and own["task"] == "pour"}
    knows = pours(own, {name: own["y"].astype(float) for name, own in recordings.items()}, 0.5)
    print(f"| who says the label as its step is read | 1 | 1 | 1, 0 | 1, {100 * knows['caught']:.0f} % | the same |", flush=True)
    net = lambda *sizes: MLPClassifier(sizes, alpha=1e-3, batch_size=512, max_iter=10, random_state=1)
    wide = MLPClassifier((128, 64), alpha=0.1, batch_size=512, max_iter=10, random_state=1)
    trees = lightgbm.LGBMClassifier(
        n_estimators=80, learning_rate=0.1, num_leaves=31, min_child_samples=200, colsample_bytree=0.4, reg_lambda=5, n_jobs=1, verbose=-1
    )
    both = lambda x: np.hstack([rich(x), raw(x)])
    for name, features, model in (
        ("the firmware's 112, 32-16", firmware, net(32, 16)),
        ("its structure functions alone, 32-16", structure, net(32, 16)),
        ("all that was thought of, 32-16", rich, net(32, 16)),
        ("the same, 128-64", rich, wide),
        ("the same, boosted trees", rich, trees),
        ("and the last 12 readings, 128-64", both, wide),
    ):
        made = {key: features(own["x"]).astype(np.float32) for key, own in recordings.items()}
        learn = np.vstack([made[key][keep] for key, keep in keeps.items()])
        mean, deviation = learn.mean(0), learn.std(0) + 1e-6
        standard = lambda values: np.clip((values - mean) / deviation, -6, 6)
        model.fit(standard(learn), labels)
        logits = {}
        for key, own in recordings.items():
            if own["part"] == "validation":
                likely = model.predict_proba(standard(made[key]))[:, 1]
                logits[key] = np.log(likely + 1e-7) - np.log(1 - likely + 1e-7)
        report(name, recordings, logits)


if __name__ == "__main__":
    main()
