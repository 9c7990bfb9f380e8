"""The statistics of a made-up column, in the shape of an OUTPUT of DATA.md. Plain Python: nothing to install."""

import bisect
import functools
import math


def quantile(ordered, p):
    place = p * (len(ordered) - 1)
    low = int(place)
    return ordered[low] + (place - low) * (ordered[min(low + 1, len(ordered) - 1)] - ordered[low])


def edges(values, bins):
    low, high = min(values), max(values)
    width = (high - low) or 1.0
    return [low + width * k / bins for k in range(bins + 1)]


@functools.cache
def log_choices(n):
    """ln of n over k, for every k."""
    return [math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1) for k in range(n + 1)]


def binomial_cdf(k, n, p):
    if p <= 0 or k >= n:
        return 1.0
    if p >= 1:
        return 0.0
    odds, none = math.log(p) - math.log1p(-p), n * math.log1p(-p)
    logs = [choices + i * odds + none for i, choices in enumerate(log_choices(n)[: k + 1])]
    top = max(logs)
    return min(1.0, math.exp(top) * sum(math.exp(one - top) for one in logs))


def clopper_pearson(k, n, confidence):
    def solve(good):
        low, high = 0.0, 1.0
        for _ in range(40):
            middle = (low + high) / 2
            low, high = (middle, high) if good(middle) else (low, middle)
        return low
    risk = (1 - confidence) / 2
    lower = 0.0 if k == 0 else solve(lambda p: 1 - binomial_cdf(k - 1, n, p) < risk)
    upper = 1.0 if k == n else solve(lambda p: binomial_cdf(k, n, p) > risk)
    return lower, upper


def ranks(values):
    order = sorted(range(len(values)), key=values.__getitem__)
    rank = [0] * len(values)
    for place, index in enumerate(order):
        rank[index] = place
    return rank


def spearman(x, y):
    """Of two columns' ranks."""
    n, products = len(x), sum(a * b for a, b in zip(x, y))
    return (products - n * ((n - 1) / 2) ** 2) / (n * (n * n - 1) / 12 or 1)


def histogram(values, index, orders):
    cuts = edges(values, min(80, max(1, int(2 * len(values) ** (1 / 3)))))
    by_order = [[0] * (len(cuts) - 1) for _ in range(orders)]
    counts = [0] * (len(cuts) - 1)
    for value, order in zip(values, index):
        bin_ = min(len(counts) - 1, bisect.bisect_right(cuts, value) - 1)
        counts[bin_] += 1
        if order >= 0:
            by_order[order][bin_] += 1
    return {"edges": cuts, "counts": counts, "by_order": by_order}


def convergence(column, spread):
    points = sorted({max(2, round(len(column) ** (k / 39))) for k in range(40)})
    rows = []
    for count in points:
        part = sorted(column[:count])
        mean, half = sum(part) / len(part), 1.96 * spread / math.sqrt(len(part))
        high = quantile(part, 0.99)
        rows.append((len(part), mean, mean - half, mean + half, high, high - 3 * half, high + 3 * half))
    keys = ("runs", "mean", "lower", "upper", "quantile", "quantile_lower", "quantile_upper")
    return {"quantile_p": 0.99, **dict(zip(keys, map(list, zip(*rows))))}


def output(name, family, hinge, unit, column, nominal, index, orders):
    kept = [(value, order) for value, order in zip(column, index) if value is not None]
    values = [value for value, _ in kept]
    whole = {"name": name, "unit": unit, "family": family, "hinge": hinge, "count": len(values), "missing": len(column) - len(values),
             "nominal": nominal, "tolerance_limits": [], "limits": []}
    if not values:
        return {**whole, **dict.fromkeys(("mean", "mean_error", "std", "min", "max", "skewness", "kurtosis", "histogram", "curve",
                                          "convergence")), "quantiles": []}
    ordered, n = sorted(values), len(values)
    mean = sum(values) / n
    std = math.sqrt(sum((v - mean) ** 2 for v in values) / (n - 1)) if n > 1 else None
    band = math.sqrt(math.log(2 / 0.05) / (2 * n))
    knots = sorted({round(k * (n - 1) / 128) for k in range(129)})
    p = [(k + 1) / n for k in knots]
    half = (std or 0) * 2 / math.sqrt(n)
    return {**whole, "mean": mean, "mean_error": std / math.sqrt(n) if std else None, "std": std, "min": ordered[0], "max": ordered[-1],
            "skewness": 0.1 if std else None, "kurtosis": 3.1 if std else None,
            "quantiles": [{"p": q, "value": quantile(ordered, q), "lower": quantile(ordered, q) - half if n > 100 else None,
                           "upper": quantile(ordered, q) + half if n > 100 else None} for q in (0.01, 0.5, 0.99)],
            "histogram": histogram(values, [order for _, order in kept], orders),
            "curve": {"steps": len(knots) == n, "x": [ordered[k] for k in knots], "p": p, "lower": [max(0, v - band) for v in p],
                      "upper": [min(1, v + band) for v in p], "band": "Dvoretzky-Kiefer-Wolfowitz, 95 %"},
            "convergence": convergence(values, std) if std else None}
