#!/usr/bin/env python3
"""Draws the rows of strike_spread as an SVG: where a limb went, beside where it was to go.

  draw_targets.py spread.csv docs/images/strike_spread.svg [summary.csv]

Top row from above, bottom row from the front; one column per method, of the first seed. Prints for
each method and seed what the third file gets: how many targets were hit, how far the limb stayed
away, and the spread of its extreme positions: the area of their hull from above and their standard
deviations.
"""
import csv
import statistics
import sys
from collections import defaultdict

PANEL, GAP, TOP, LEFT, BOTTOM = 220, 14, 52, 58, 46
AXES = [("from above", "x", "z", "z [m]"), ("from the front", "x", "y", "height y [m]")]
LABELS = {"ik": "IK variants, uncorrected", "strike_0.3": "strike task, weight 0.3",
          "strike_0.7": "strike task, weight 0.7", "ours": "ours: IK, then corrected"}
COLOURS = {"ik": "#7a7a7a", "strike_0.3": "#e09f3e", "strike_0.7": "#d1495b", "ours": "#1f6fb4"}


def read(path):
    """method -> seed -> rows"""
    rows = defaultdict(lambda: defaultdict(list))
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            rows[row["method"]][int(row["seed"])].append(row)
    return rows


def column(rows, name):
    return [float(row[name]) for row in rows]


def hull_area(points):
    """Of the convex hull (Andrew's monotone chain)."""
    points = sorted(set(points))

    def chain(ordered):
        out = []
        for p in ordered:
            while len(out) > 1 and ((out[-1][0] - out[-2][0]) * (p[1] - out[-2][1]) -
                                    (out[-1][1] - out[-2][1]) * (p[0] - out[-2][0])) <= 0:
                out.pop()
            out.append(p)
        return out[:-1]

    hull = chain(points) + chain(points[::-1])
    shifted = hull[1:] + hull[:1]
    return abs(sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(hull, shifted))) / 2


def summary(method, seed, rows):
    miss = column(rows, "miss_m")
    extremes = {axis: column(rows, f"extreme_{axis}") for axis in "xyz"}
    out = {"clip": rows[0]["clip"], "method": method, "seed": seed, "variants": len(rows)}
    simulated = method != "ik"
    out["completed"] = sum(row["completed"] == "1" for row in rows) if simulated else ""
    for name in ("reward_normalised", "force_mean_bw", "torque_mean_nm"):
        out[name] = f"{statistics.mean(column(rows, name)):.4f}" if simulated else ""
    for cm in (5, 10, 20):
        out[f"hit_{cm}cm"] = sum(m <= cm / 100 for m in miss)
    out["miss_median_m"] = f"{statistics.median(miss):.4f}"
    out["hull_m2"] = f'{hull_area(list(zip(extremes["x"], extremes["z"]))):.4f}'
    for axis in "xyz":
        out[f"deviation_{axis}_m"] = f"{statistics.pstdev(extremes[axis]):.4f}"
    out["samples"], out["commit"] = rows[0]["samples"], rows[0]["commit"]
    return out


def text(x, y, words, more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{words}</text>'


def dots(points, at, style, radius):
    return [f'<circle cx="{at(*p)[0]:.1f}" cy="{at(*p)[1]:.1f}" r="{radius}" {style}/>'
            for p in points]


def draw(methods, source, targets, path):
    names = {axis: column(targets, f"target_{axis}") +
             [v for rows in methods.values() for v in column(rows, f"extreme_{axis}")]
             for axis in "xyz"}
    span = 1.08 * max(max(v) - min(v) for v in names.values())
    width = LEFT + len(methods) * (PANEL + GAP)
    height = TOP + len(AXES) * (PANEL + BOTTOM) + 26
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           'font-family="sans-serif" font-size="11">',
           '<rect width="100%" height="100%" fill="white"/>']
    for row, (view, across, up, label) in enumerate(AXES):
        y0 = TOP + row * (PANEL + BOTTOM)
        low = {axis: (min(names[axis]) + max(names[axis]) - span) / 2 for axis in (across, up)}
        for index, (method, rows) in enumerate(methods.items()):
            x0 = LEFT + index * (PANEL + GAP)

            def at(u, v, x0=x0, y0=y0, low=low):
                return (x0 + PANEL * (u - low[across]) / span,
                        y0 + PANEL * (1 - (v - low[up]) / span))

            out.append(f'<rect x="{x0}" y="{y0}" width="{PANEL}" height="{PANEL}" fill="none" '
                       'stroke="#bbb"/>')
            if row == 0:
                done = summary(method, 0, rows)
                out.append(text(x0, 18, LABELS.get(method, method),
                                'font-weight="bold" font-size="13"'))
                out.append(text(x0, 34, f'{done["hit_10cm"]} of {done["variants"]} within 10 cm; '
                                f'hull {float(done["hull_m2"]):.3f} m²'))
            for k in range(-30, 31):
                tick = k / 5
                if low[across] < tick < low[across] + span:
                    x = at(tick, low[up])[0]
                    out.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{y0}" y2="{y0 + PANEL}" '
                               'stroke="#eee"/>')
                    out.append(text(x, y0 + PANEL + 14, f"{tick:.1f}", 'text-anchor="middle"'))
                if low[up] < tick < low[up] + span:
                    y = at(low[across], tick)[1]
                    out.append(f'<line x1="{x0}" x2="{x0 + PANEL}" y1="{y:.1f}" y2="{y:.1f}" '
                               'stroke="#eee"/>')
                    if index == 0:
                        out.append(text(x0 - 5, y + 4, f"{tick:.1f}", 'text-anchor="end"'))
            out.append(text(x0 + PANEL / 2, y0 + PANEL + 28, "x [m]", 'text-anchor="middle"'))
            if index == 0:
                out.append(text(14, y0 + PANEL / 2, f"{view}: {label}", 'text-anchor="middle" '
                                f'transform="rotate(-90 14 {y0 + PANEL / 2})"'))
            wanted = list(zip(column(targets, f"target_{across}"), column(targets, f"target_{up}")))
            reached = list(zip(column(rows, f"extreme_{across}"), column(rows, f"extreme_{up}")))
            out += dots(wanted, at, 'fill="none" stroke="#aaa"', 2.5)
            out += dots(reached, at, f'fill="{COLOURS.get(method, "#333")}" opacity="0.75"', 3)
            x, y = at(float(source[f"extreme_{across}"]), float(source[f"extreme_{up}"]))
            out.append(f'<path d="M{x - 6:.1f},{y:.1f}h12M{x:.1f},{y - 6:.1f}v12" stroke="black" '
                       'stroke-width="2"/>')
    y = height - 10
    out += [f'<circle cx="{LEFT + 4}" cy="{y - 4}" r="2.5" fill="none" stroke="#aaa"/>',
            text(LEFT + 14, y, "target"),
            f'<circle cx="{LEFT + 74}" cy="{y - 4}" r="3" fill="#333" opacity="0.75"/>',
            text(LEFT + 84, y, "foot where it is farthest from the pelvis, in one motion"),
            f'<path d="M{LEFT + 404},{y - 4}h12m-6,-6v12" stroke="black" stroke-width="2"/>',
            text(LEFT + 424, y, "the same of the original motion"), "</svg>"]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n")


def main(source, target, table=None):
    rows = read(source)
    original = next(iter(rows.pop("source").values()))[0]
    lines = [summary(method, seed, rows[method][seed]) for method in LABELS if method in rows
             for seed in sorted(rows[method])]
    for line in lines:
        print(line)
    if table:
        with open(table, "w", newline="", encoding="utf-8") as file:
            out = csv.DictWriter(file, lines[0], lineterminator="\n")
            out.writeheader()
            out.writerows(lines)
    first = {method: rows[method][min(rows[method])] for method in LABELS if method in rows}
    draw(first, original, first["ik"], target)


if __name__ == "__main__":
    main(*sys.argv[1:4])
