#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the table of `spectral_benchmark --scaling`: plot_scaling.py scaling.csv scaling.svg"""

import csv
import math
import sys

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]
DASHES = ["", "7,3", "2,3", "9,3,2,3", "14,4", "4,4"]
WIDTH, HEIGHT, LEFT, TOP = 380, 300, 70, 40


def ticks(low, high):
    """1, 2 and 5 times powers of ten, at least one on each side of the values."""
    values = [m * 10.0**e for e in range(-4, 8) for m in (1, 2, 5)]
    first = max([v for v in values if v <= low], default=values[0])
    last = min([v for v in values if v >= high], default=values[-1])
    return [v for v in values if first <= v <= last]


def label(value):
    if value >= 1e6:
        return f"{value / 1e6:g}M"
    return f"{value / 1e3:g}k" if value >= 1e3 else f"{value:g}"


def panel(x0, title, curves):
    """One diagram with logarithmic axes; curves: (name, [(x, y)])."""
    xs = [x for _, points in curves for x, _ in points]
    ys = [y for _, points in curves for _, y in points]
    xticks, yticks = ticks(min(xs), max(xs)), ticks(min(ys), max(ys))

    def px(x):
        return x0 + WIDTH * math.log(x / xticks[0]) / math.log(xticks[-1] / xticks[0])

    def py(y):
        return TOP + HEIGHT * (1 - math.log(y / yticks[0]) / math.log(yticks[-1] / yticks[0]))

    svg = [f'<text x="{x0 + WIDTH / 2}" y="{TOP - 15}" text-anchor="middle" font-weight="bold">{title}</text>']
    for x in xticks:
        svg.append(f'<line x1="{px(x):.1f}" y1="{TOP}" x2="{px(x):.1f}" y2="{TOP + HEIGHT}" stroke="#ddd"/>')
        svg.append(f'<text x="{px(x):.1f}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{label(x)}</text>')
    for y in yticks:
        svg.append(f'<line x1="{x0}" y1="{py(y):.1f}" x2="{x0 + WIDTH}" y2="{py(y):.1f}" stroke="#ddd"/>')
        svg.append(f'<text x="{x0 - 6}" y="{py(y) + 4:.1f}" text-anchor="end">{label(y)}</text>')
    svg.append(f'<text x="{x0 + WIDTH / 2}" y="{TOP + HEIGHT + 36}" text-anchor="middle">vertices</text>')
    for i, (name, points) in enumerate(curves):
        colour, dash = COLOURS[i % 6], DASHES[i % 6]
        path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in points)
        svg.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        svg += [f'<circle cx="{px(x):.1f}" cy="{py(y):.1f}" r="3" fill="{colour}"/>' for x, y in points]
        y = TOP + HEIGHT + 56 + 18 * (i // 3)
        x = x0 + 130 * (i % 3)
        svg.append(f'<line x1="{x}" y1="{y - 4}" x2="{x + 26}" y2="{y - 4}" stroke="{colour}" stroke-width="2" '
                   f'stroke-dasharray="{dash}"/><text x="{x + 32}" y="{y}">{name}</text>')
    return svg


def main(source, target):
    with open(source, newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        sys.exit(f"plot_scaling.py: {source} has no rows")
    numbers = sorted({int(row["eigenvectors"]) for row in rows})

    def curve(column, K):
        return [(float(r["vertices"]), float(r[column])) for r in rows if int(r["eigenvectors"]) == K]

    rival = {}  # measured again for each K: the mean
    for r in rows:
        rival.setdefault(float(r["vertices"]), []).append(float(r["us_per_collapse_garland_heckbert"]))
    collapse = [(f"K = {K}", curve("us_per_collapse", K)) for K in numbers]
    collapse.append(("Garland-Heckbert", [(n, sum(v) / len(v)) for n, v in sorted(rival.items())]))
    total = [(f"K = {K}", curve("seconds_total", K)) for K in numbers]
    svg = panel(LEFT, f"microseconds per collapse, {rows[0]['threads']} threads", collapse)
    svg += panel(LEFT + WIDTH + 80, "seconds in all, eigenpairs included", total)
    size = f"{2 * WIDTH + 80 + LEFT + 30} {TOP + HEIGHT + 90}"
    with open(target, "w") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" font-family="sans-serif" '
                   'font-size="12">\n<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(svg) + "\n</svg>\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
