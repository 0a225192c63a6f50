#!/usr/bin/env python3
"""Runs the commands in README.md and docs/*.md and compares what they print with what stands there.

A command is a line "$ ..." in a ```console block; its output, stdout then stderr, follows. Commands
run in the project's folder, with the folder of the gonio command first on the path.

Usage: check_docs.py FOLDER_OF_GONIO [--update]     (--update writes the output into the pages)
"""
import difflib
import os
import pathlib
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent


def run(command, environment):
    result = subprocess.run(["bash", "-c", command], cwd=PROJECT, env=environment, text=True,
                            stdin=subprocess.DEVNULL, capture_output=True)
    return (result.stdout + result.stderr).splitlines()


def with_true_output(lines, environment):
    """The page's lines with the output of every command as it is now, and the number of commands."""
    page, commands, in_block = [], 0, False
    for line in lines:
        if line.startswith("```"):
            in_block = not in_block and line == "```console"
            page.append(line)
        elif in_block and line.startswith("$ "):
            commands += 1
            page += [line, *run(line[2:], environment)]
        elif not in_block:
            page.append(line)
    return page, commands


def main():
    update = "--update" in sys.argv
    folder = pathlib.Path(sys.argv[1]).resolve()
    environment = dict(os.environ, PATH=f"{folder}{os.pathsep}{os.environ['PATH']}", LC_ALL="C")
    differing, commands = 0, 0
    for path in [PROJECT / "README.md", *sorted((PROJECT / "docs").glob("*.md"))]:
        lines = path.read_text().splitlines()
        page, count = with_true_output(lines, environment)
        commands += count
        if page == lines:
            continue
        if update:
            path.write_text("\n".join(page) + "\n")
            continue
        differing += 1
        name = str(path.relative_to(PROJECT))
        print("\n".join(difflib.unified_diff(lines, page, name, name + " (now)", lineterm="")))
    print(f"{commands} commands in the pages, {differing} pages differ from what is printed")
    return 1 if differing or commands == 0 else 0


sys.exit(main())
