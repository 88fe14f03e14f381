#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of `telemime-lab experiments` from its CSV files and writes report.html beside them.

Usage: plots.py [FOLDER]   (out/experiments). Needs Debian's python3-matplotlib.
"""
import base64
import csv
import html
import io
import json
import pathlib
import re
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams.update({"svg.hashsalt": "telemime", "figure.figsize": (6.4, 4.0), "font.size": 9})
import matplotlib.pyplot as plt  # noqa: E402

REGIONS, EDGES = "region iterations", "edge iterations"
# The measure of the grid that each figure shows, and whether it is the mean of the gestures.
GRID = {"F3-16": ("mean F", True), "F3-17": ("mean D_C (px)", True), "F3-18": ("mistracked by F", True),
        "F3-19": ("mistracked by D_C", True), "F3-26": ("3-D error (mm)", False),
        "F3-27": ("2-D error (mm)", False)}
LONGEST_TABLE = 45  # rows in the report; longer ones are in the CSV files


def read_table(text):
    rows = list(csv.reader(io.StringIO(text)))
    return rows[0], rows[1:]


def value(text):
    """The first number of a field ("20 +- 3", "160x120 ..."); NaN where there is none."""
    match = re.match(r"-?[0-9.]+(e[+-]?[0-9]+)?", text)
    return float(match.group()) if match and not match.group() == "-" else float("nan")


def column(table, name):
    return [value(row[table[0].index(name)]) for row in table[1]]


def lines(axes, table, x, names):
    for name in names:
        axes.plot(column(table, x), column(table, name), label=name)
    axes.set(xlabel=x, ylim=(0, None))
    axes.legend()


def bands(axes, table, title):
    """Mean of each filter over the particles with the spread over the seeds."""
    x = column(table, "particles")
    for name in (c[: -len(", lowest")] for c in table[0] if c.endswith(", lowest")):
        axes.plot(x, column(table, name), label=name)
        axes.fill_between(x, column(table, name + ", lowest"), column(table, name + ", highest"), alpha=0.2)
    axes.set(title=title, xlabel="particles", ylim=(0, None))
    axes.legend()


def heat(axes, x, y, z, title):
    image = axes.pcolormesh(x, y, z, shading="nearest", cmap="coolwarm")
    axes.figure.colorbar(image)
    axes.set(title=title, xlabel=REGIONS + " (evaluations of F)", ylabel=EDGES + " (evaluations of D_C)")


def grid_figure(axes, table, measure, sequences):
    x = sorted(set(column(table, REGIONS)))
    cells = [[0.0] * len(x) for _ in x]
    for name, r, e, z in zip([row[0] for row in table[1]], column(table, REGIONS), column(table, EDGES),
                             column(table, measure)):
        if name in sequences:
            cells[x.index(e)][x.index(r)] += z / len(sequences)
    heat(axes, x, x, cells, f"{measure}, {', '.join(sequences)}")


def fit_figure(axes, table):
    """The quadratic z = A + B x + C y + D x^2 + F y^2 + G x y of figure 3-28."""
    a, b, c, d, f, g, limit = (column(table, name)[0] for name in ("A", "B", "C", "D", "F", "G", "limit"))
    x = [limit * i / 25 for i in range(26)]
    z = [[a + b * u + c * v + d * u * u + f * v * v + g * u * v for u in x] for v in x]
    heat(axes, x, x, z, "Quadratic fit of the mean 2-D error (mm)")


def groups(table):
    """The table's rows by their first field."""
    names = list(dict.fromkeys(row[0] for row in table[1]))
    return [(name, (table[0], [row for row in table[1] if row[0] == name])) for name in names]


def figures(section_id, tables):
    """(file name, drawing function) for each figure of a section."""
    for title, table in tables.items():
        columns = table[0]
        if title == "grid":
            measure, averaged = GRID[section_id]
            names = [name for name, _ in groups(table)]
            for shown in [names] if averaged else [[name] for name in names]:
                name = "plot" if averaged else shown[0]
                yield name, lambda axes, t=table, m=measure, s=shown: grid_figure(axes, t, m, s)
        elif columns[0] == "frame":
            yield "plot", lambda axes, t=table: lines(axes, t, "frame", t[0][1:])
        elif columns[0] == "particles":
            yield "plot", lambda axes, t=table, n=title: bands(axes, t, n)
        elif columns[1:2] == ["particles"]:
            for name, part in groups(table):
                yield name, lambda axes, t=part, n=f"{title}: {name}": bands(axes, t, n)
        elif title == "coefficients":
            split = tables.get("best split")

            def draw(axes, t=table, path=split):
                fit_figure(axes, t)
                if path:
                    axes.plot(column(path, "region"), column(path, "edge"), "k.-")

            yield "plot", draw
        elif title == "along the line":
            yield "plot", lambda axes, t=table: lines(axes, t, REGIONS, ["fitted 2-D error (mm)"])
        elif columns[0] in ("iterations", "histograms"):
            names = [c for c in columns[1:] if "features" not in c and "search" not in c]
            yield "plot", lambda axes, t=table, x=columns[0], n=names: (lines(axes, t, x, n), axes.set_ylabel("ms"))
        elif columns[0] == "size":
            pixels = [str(eval_size(row[0])) for row in table[1]]
            sized = (["thousand pixels"] + columns[1:], [[p] + row[1:] for p, row in zip(pixels, table[1])])
            yield "plot", lambda axes, t=sized: (lines(axes, t, "thousand pixels", ["F us", "D_C us"]),
                                                 axes.set_ylabel("us"))


def eval_size(size):
    width, height = size.split("x")
    return 1e-3 * int(width) * int(height)


def table_html(table, caption):
    def row(fields, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(f)}</{tag}>" for f in fields) + "</tr>"

    return (f"<table><caption>{html.escape(caption)}</caption>" + row(table[0], "th") +
            "".join(row(fields, "td") for fields in table[1]) + "</table>")


def section_html(folder, section):
    tables = {t["title"]: read_table((folder / t["file"]).read_text()) for t in section["tables"]}
    parts = [f"<h2 id=\"{section['id']}\">{section['id']} {html.escape(section['title'])}</h2>",
             f"<p>{html.escape(section['question'])}</p>", table_html(read_table(section["published"]), "published")]
    parts += [table_html(table, title) for title, table in tables.items() if len(table[1]) <= LONGEST_TABLE]
    for name, draw in figures(section["id"], tables):
        figure, axes = plt.subplots(layout="constrained")
        draw(axes)
        figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
        plt.close(figure)
        parts.append((folder / f"{name}.svg").read_text().split("?>", 1)[-1])
    if (folder / "picture.png").exists():
        data = base64.b64encode((folder / "picture.png").read_bytes()).decode()
        parts.append(f"<img alt=\"\" src=\"data:image/png;base64,{data}\">")
    parts += [f"<p>{html.escape(note)}</p>" for note in section["notes"]]
    return "\n".join(parts + [f"<p class=\"verdict\">{html.escape(section['verdict'])}</p>"])


STYLE = """body { font: 16px/1.5 sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
table { display: block; overflow-x: auto; border-collapse: collapse; margin: 1rem 0; font-size: .86rem; }
td, th { border: 1px solid #ccc; padding: .15rem .5rem; text-align: left; }
.verdict { background: #eef4ee; border-left: 4px solid #2a8a4a; padding: .4rem .8rem; }
svg, img { max-width: 100%; height: auto; }"""


def main():
    out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/experiments")
    sections = [json.loads(file.read_text()) for file in out.glob("*/section.json")]
    if not sections:
        sys.exit(f"plots.py: there is no {out}/*/section.json; run `telemime-lab experiments` first")
    # Figures and tables in numerical order, then the experiments that have no number.
    sections.sort(key=lambda s: [int(n) for n in re.findall(r"\d+", s["id"])] or [99])
    title = "The thesis's experiments, measured again"
    conditions = (out / "conditions.txt").read_text().splitlines()
    page = [f"<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>"
            f"<style>{STYLE}</style></head><body><h1>{title}</h1><ul>"]
    page += [f"<li>{html.escape(line)}</li>" for line in conditions]
    page += ["</ul><ul>"]
    page += [f"<li><a href=\"#{s['id']}\">{s['id']}</a> {html.escape(s['title'])}. {html.escape(s['verdict'])}</li>"
             for s in sections]
    page += ["</ul>"] + [section_html(out / s["id"], s) for s in sections] + ["</body></html>"]
    (out / "report.html").write_text("\n".join(page))
    print(out / "report.html")


if __name__ == "__main__":
    main()
