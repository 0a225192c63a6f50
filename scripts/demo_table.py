#!/usr/bin/python3
"""Prints truth, estimate and 95 % interval of fitted materials side by side.

Usage: demo_table.py RECIPE MATERIAL [RECIPE MATERIAL]..
       demo_table.py --model RECIPE      prints the recipe's model

A recipe (schema/recipe.schema.json) holds the truth, a material (schema/material.schema.json) what
was fitted to the table that the recipe makes.
"""
import json
import sys

ROW = "{:<26} {:<8} {:>8} {:>10}   {:<21} {}"


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def as_list(value):
    return value if isinstance(value, list) else [value]


def compare(recipe, material):
    """Yields (parameter, truth, estimate, interval) for each scalar of each parameter."""
    channels = material["channels"]
    for name, fitted in material["parameters"].items():
        truths = as_list(recipe["parameters"][name])
        estimates = as_list(fitted["value"])
        intervals = fitted["interval95"] if isinstance(fitted["value"], list) else [fitted["interval95"]]
        for k, estimate in enumerate(estimates):
            label = name if len(estimates) == 1 else f"{name}.{channels[k]}"
            yield label, truths[k if len(truths) > 1 else 0], estimate, intervals[k]


def main(paths):
    if paths[0] == "--model":
        print(load(paths[1])["model"])
        return
    held, total = 0, 0
    print(ROW.format("material", "", "truth", "estimate", "95 % interval", "holds the truth"))
    for recipe_path, material_path in zip(paths[::2], paths[1::2]):
        recipe, material = load(recipe_path), load(material_path)
        title = recipe["name"]
        for name, truth, estimate, interval in compare(recipe, material):
            inside, text = False, "not determined"
            if interval is not None:
                inside = interval[0] <= truth <= interval[1]
                text = f"{interval[0]:.5f} .. {interval[1]:.5f}"
            held, total = held + inside, total + 1
            mark = "yes" if inside else "NO"
            print(ROW.format(title, name, f"{truth:g}", f"{estimate:.5f}", text, mark))
            title = ""
    print(f"{held} of {total} intervals hold the truth; of 95 % intervals, 1 in 20 misses it.")


if len(sys.argv) < 3:
    sys.exit(__doc__)
main(sys.argv[1:])
