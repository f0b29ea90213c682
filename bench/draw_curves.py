#!/usr/bin/env python3
"""Draws the curves of correction_learning as an SVG: median over seeds and their range.

  draw_curves.py compare_curve.csv docs/images/residual_comparison.svg
Prints the area under each median curve of the normalised reward.
"""
import csv
import statistics
import sys
from collections import defaultdict

WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 340, 220, 44, 30, 34
COLOURS = ["#1f6fb4", "#d1495b", "#7a7a7a", "#2e8b57", "#e09f3e", "#6a4c93"]
PANELS = [("reward_normalised", "normalised reward", 1.0),
          ("force_mean_bw", "mean outer force [body weights]", None)]


def read(path):
    """method -> column -> samples -> values over seeds"""
    curves = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            for column, _, _ in PANELS:
                curves[row["method"]][column][int(row["samples"])].append(float(row[column]))
    return curves


def area(points):
    """Mean height of (x, y) points over their range."""
    total = sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in zip(points, points[1:]))
    return total / (points[-1][0] - points[0][0])


def panel(curves, column, title, top, left):
    most_x = max(x for c in curves.values() for x in c[column])
    most_y = top or 1.1 * max(max(v) for c in curves.values() for v in c[column].values())
    inner_w, inner_h = WIDTH - LEFT - 10, HEIGHT - TOP - BOTTOM

    def at(x, y):
        return f"{left + LEFT + inner_w * x / most_x:.1f},{TOP + inner_h * (1 - y / most_y):.1f}"

    out = [f'<text x="{left + LEFT}" y="18" font-weight="bold">{title}</text>']
    for k in range(6):
        y = most_y * k / 5
        out.append(f'<polyline points="{at(0, y)} {at(most_x, y)}" stroke="#ddd" fill="none"/>')
        out.append(f'<text x="{left + LEFT - 5}" y="{float(at(0, y).split(",")[1]) + 4:.1f}" '
                   f'text-anchor="end">{y:.2f}</text>')
    for k in range(4):
        x = most_x * k / 3
        out.append(f'<text x="{at(x, 0).split(",")[0]}" y="{HEIGHT - BOTTOM + 16}" '
                   f'text-anchor="middle">{x / 1000:.0f}k</text>')
    for index, (method, columns) in enumerate(curves.items()):
        points = sorted(columns[column].items())
        colour = COLOURS[index % len(COLOURS)]
        band = [at(x, max(v)) for x, v in points] + [at(x, min(v)) for x, v in reversed(points)]
        line = [at(x, statistics.median(v)) for x, v in points]
        out.append(f'<polygon points="{" ".join(band)}" fill="{colour}" opacity="0.15"/>')
        out.append(f'<polyline points="{" ".join(line)}" stroke="{colour}" fill="none" '
                   'stroke-width="2"/>')
    return out


def main(source, target):
    curves = read(source)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * WIDTH + 20}" '
           f'height="{HEIGHT + 16 + 16 * len(curves)}" font-family="sans-serif" font-size="11">',
           '<rect width="100%" height="100%" fill="white"/>']
    for k, (column, title, top) in enumerate(PANELS):
        out += panel(curves, column, title, top, k * (WIDTH + 10))
    for index, (method, columns) in enumerate(curves.items()):
        y = HEIGHT + 12 + 16 * index
        points = [(x, statistics.median(v))
                  for x, v in sorted(columns["reward_normalised"].items())]
        print(f"{method}: area under the median curve {area(points):.4f}")
        out.append(f'<rect x="{LEFT}" y="{y - 8}" width="14" height="4" '
                   f'fill="{COLOURS[index % len(COLOURS)]}"/>')
        out.append(f'<text x="{LEFT + 20}" y="{y}">{method.replace("_", " ")}, area '
                   f'{area(points):.3f}</text>')
    out.append("</svg>")
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:3])
