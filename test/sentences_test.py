#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# sentences_test.py SOURCE: the sentences of the pages that users read. Fails where one has more
# than 40 words, where those of a page have more than 25 in the mean, or where a phrase is one that
# must be read twice. Code, tables, headings, formulas and references do not count.

import os
import re
import sys

PAGES = ("README.md", "CHANGES.md", "doc/tutorial.md", "doc/how_to.md", "doc/reference.md",
         "doc/measurements.md", "doc/applications.md", "doc/robustness.md", "doc/commands.md",
         "doc/installation.md", "doc/results.md", "doc/rivals.md", "doc/experiments.md",
         "doc/contributing.md", "doc/promises.md", "examples/python/README.md")
LONGEST, MEAN = 40, 25
PHRASES = ("that of", "such as are", "of late", "those of whom", "of which the first")
# A dot behind these ends no sentence.
ABBREVIATIONS = ("et al", "Eq", "Fig", "e.g", "i.e", "vs")


def paragraphs(page):
    """The prose of a page: paragraphs and items of lists, without code, tables and headings."""
    page = re.sub(r"<!--.*?-->", "", page, flags=re.S)
    result, current, fenced, references = [], [], False, False
    for line in page.splitlines() + [""]:
        if line.lstrip().startswith("```"):
            fenced = not fenced
        if line.startswith("#"):
            references = line.strip("# ") == "References"
        prose = not (fenced or references or re.match(r"\s*(```|\||#|!\[)| {4}\S.*|\s*$", line))
        item = re.match(r"\s*([-*]|\d+\.) ", line)
        # An item goes on in lines that are indented by four; code has none before it.
        goes_on = current and line.startswith("    ") and not fenced and line.strip()
        if current and (item or not (prose or goes_on)):
            result.append(" ".join(current))
            current = []
        if prose or goes_on:
            current.append(line.strip()[len(item.group(1)) if item else 0:].strip())
    return result


def sentences(paragraph):
    """The sentences of a paragraph. An excerpt of code is a word, a link its text."""
    text = re.sub(r"(`+)[^`]+\1", "code", paragraph)
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text)
    for abbreviation in ABBREVIATIONS:
        text = re.sub(r"\b" + re.escape(abbreviation) + r"\. ", abbreviation + " ", text)
    return [part for part in re.split(r"(?<=[.!?])[)*\"]*\s+", text) if part]


def words(sentence):
    """How many words there are; the letters and signs of formulas are none."""
    return sum(1 for token in sentence.split()
               if re.search(r"[A-Za-z]{2}|\d", token) or token.strip("(\"*") in ("a", "A", "I"))


def faults(page):
    counted = [(words(s), s) for p in paragraphs(page) for s in sentences(p)]
    counted = [(n, s) for n, s in counted if n > 1]
    found = [f"{n} words: {s}" for n, s in counted if n > LONGEST]
    mean = sum(n for n, _ in counted) / max(len(counted), 1)
    if mean > MEAN:
        found.append(f"{mean:.1f} words in the mean of {len(counted)} sentences")
    prose = re.sub(r"```.*?```|`[^`]*`", "", page, flags=re.S)
    prose = re.sub(r"\s+", " ", prose)
    for phrase in PHRASES:
        for hit in re.finditer(r"\b" + phrase + r"\b", prose, re.I):
            found.append(f"'{phrase}': …{prose[max(hit.start() - 40, 0):hit.end() + 40]}…")
    return found, len(counted)


def self_test():
    def verdict(page):
        return faults(page)[0]

    long = " ".join(["word"] * 41) + "."
    assert verdict("Well.\n\n" + "A short sentence here. " * 9 + "\n\n- An item, " + long)
    assert verdict("A link [" + long[:-1] + "](x.md) ends. " + "A short one. " * 20)
    assert not verdict(" ".join(["word"] * 40) + ".\n\nShort ones are here. Short ones are here.")
    assert verdict((" ".join(["word"] * 26) + ". ") * 3)
    assert verdict("The mass is that\nof the input. It is short.")
    assert verdict("| a | costs of late |\n")
    assert not verdict("A page.\n\n```\nthat of " + long + "\n```\n\n    " + long + "\n\n| " + long)
    assert len(sentences("Lescoat et al. 2020 say so in Eq. 2. It is 0.5 `a. B` long.")) == 2
    assert paragraphs("- one\n  two\n- three\n\nfour") == ["one two", "three", "four"]


def main():
    self_test()
    status = 0
    for name in PAGES:
        with open(os.path.join(sys.argv[1], name), encoding="utf-8") as file:
            page = file.read()
        if name == "CHANGES.md":  # former versions stay as they are
            page = "".join(re.split(r"(?m)^(?=## )", page)[:2])
        found, number = faults(page)
        if number < 4:
            found.append(f"only {number} sentences were found")
        for fault in found:
            print(f"{name}: {fault}")
            status = 1
    sys.exit(status)


main()
