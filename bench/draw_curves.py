#!/usr/bin/env python3
"""Draws the curves of correction_learning as an SVG: median over seeds and their range.

  draw_curves.py compare_curve.csv docs/images/residual_comparison.svg [areas.csv]

A method with one point, such as a policy that did not learn, is drawn as a level. Prints the area
under each curve of the normalised reward (its mean height over the samples), of each seed, and
writes these rows to the third file.
"""
import csv
import math
import statistics
import sys
from collections import defaultdict

WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 430, 300, 62, 34, 48
COLOURS = ["#7a7a7a", "#6a4c93", "#e09f3e", "#1f6fb4", "#2e8b57", "#d1495b"]
PANELS = [("reward_normalised", "Normalised reward", 1.0),
          ("force_mean_bw", "Mean outer force [body weights]", None)]
LABELS = {"zero": "zero policy, PD-residual", "none": "PPO, no residual force",
          "rfc": "PPO, learned residual (RFC)", "pd": "PPO, PD-residual (MotionAug)",
          "ours": "ours (effort full, policy alone)"}


def read(path):
    """method -> seed -> rows by samples"""
    curves = defaultdict(lambda: defaultdict(list))
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            curves[row["method"]][int(row["seed"])].append(row)
    known = list(LABELS)
    order = sorted(curves, key=lambda m: known.index(m) if m in known else len(known))
    return {method: curves[method] for method in order}


def points(rows, column, most_x):
    """(samples, value) of one seed; a level if it has but one"""
    found = sorted((int(row["samples"]), float(row[column])) for row in rows)
    return found if len(found) > 1 else [(0, found[0][1]), (most_x, found[0][1])]


def over_seeds(seeds, column, most_x):
    """(samples, values of the seeds), for as long as all seeds have learned"""
    values = defaultdict(list)
    for rows in seeds.values():
        for x, y in points(rows, column, most_x):
            values[x].append(y)
    return sorted((x, v) for x, v in values.items() if len(v) == len(seeds))


def area(curve):
    """Mean height of (x, y) points over their range."""
    total = sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in zip(curve, curve[1:]))
    return total / (curve[-1][0] - curve[0][0])


def panel(curves, column, title, top, left, most_x):
    drawn = {method: over_seeds(seeds, column, most_x) for method, seeds in curves.items()}
    most_y = top or 1.05 * max(max(v) for curve in drawn.values() for _, v in curve)
    inner_w, inner_h = WIDTH - LEFT - 14, HEIGHT - TOP - BOTTOM

    def at(x, y):
        return f"{left + LEFT + inner_w * x / most_x:.1f},{TOP + inner_h * (1 - y / most_y):.1f}"

    def text(x, y, words, more=""):
        return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{words}</text>'

    out = [text(left + LEFT, 20, title, 'font-weight="bold" font-size="13"')]
    for k in range(6):
        y = most_y * k / 5
        height = TOP + inner_h * (1 - k / 5)
        out.append(f'<polyline points="{at(0, y)} {at(most_x, y)}" stroke="#ddd" fill="none"/>')
        out.append(text(left + LEFT - 6, height + 4, f"{y:.2f}", 'text-anchor="end"'))
    step = 10 ** math.floor(math.log10(most_x))
    for x in range(0, most_x + 1, step if most_x >= 2 * step else step // 4):
        out.append(text(left + LEFT + inner_w * x / most_x, HEIGHT - BOTTOM + 16,
                        f"{x / 1000:.0f}k", 'text-anchor="middle"'))
    out.append(text(left + LEFT + inner_w / 2, HEIGHT - BOTTOM + 34,
                    "samples learned from (actions, 30 a second)", 'text-anchor="middle"'))
    for index, (method, curve) in enumerate(drawn.items()):
        colour = COLOURS[index % len(COLOURS)]
        band = [at(x, max(v)) for x, v in curve] + [at(x, min(v)) for x, v in reversed(curve)]
        line = [at(x, statistics.median(v)) for x, v in curve]
        dashes = ' stroke-dasharray="6 4"' if len(curve) == 2 else ""
        out.append(f'<polygon points="{" ".join(band)}" fill="{colour}" opacity="0.2"/>')
        out.append(f'<polyline points="{" ".join(line)}" stroke="{colour}" fill="none" '
                   f'stroke-width="2"{dashes}/>')
    return out


def write_areas(path, curves, most_x):
    with open(path, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["clip", "method", "seed", "samples", "area_reward_normalised",
                      "last_reward_normalised", "last_completed", "last_variants",
                      "last_force_mean_bw", "last_torque_mean_nm", "commit"])
        for method, seeds in curves.items():
            for seed, rows in sorted(seeds.items()):
                rows = sorted(rows, key=lambda row: int(row["samples"]))
                last = rows[-1]
                height = area(points(rows, "reward_normalised", most_x))
                out.writerow([last["clip"], method, seed, last["samples"], f"{height:.4f}",
                              last["reward_normalised"], last["completed"], last["variants"],
                              last["force_mean_bw"], last["torque_mean_nm"], last["commit"]])


def main(source, target, areas=None):
    curves = read(source)
    most_x = max(int(row["samples"]) for seeds in curves.values()
                 for rows in seeds.values() for row in rows)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * WIDTH + 10}" '
           f'height="{HEIGHT + 14 + 18 * len(curves)}" font-family="sans-serif" font-size="11">',
           '<rect width="100%" height="100%" fill="white"/>']
    for k, (column, title, top) in enumerate(PANELS):
        out += panel(curves, column, title, top, k * (WIDTH + 10), most_x)
    for index, (method, seeds) in enumerate(curves.items()):
        heights = [area(points(rows, "reward_normalised", most_x)) for rows in seeds.values()]
        label = (f"{LABELS.get(method, method)}: area under the reward's curve "
                 f"{statistics.median(heights):.3f} ({min(heights):.3f} to {max(heights):.3f}, "
                 f"{len(heights)} seeds)")
        print(label)
        y = HEIGHT + 12 + 18 * index
        out.append(f'<rect x="{LEFT}" y="{y - 7}" width="18" height="5" '
                   f'fill="{COLOURS[index % len(COLOURS)]}"/>')
        out.append(f'<text x="{LEFT + 26}" y="{y}">{label}</text>')
    out.append("</svg>")
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n")
    if areas:
        write_areas(areas, curves, most_x)


if __name__ == "__main__":
    main(*sys.argv[1:4])
