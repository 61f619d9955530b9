#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks a folder OUT/thermal as tools for training do: COCO document, YOLO labels, lists of the parts, pictures.

    python3 tests/tools/check_dataset.py OUT/thermal

Prints what is wrong, one line each, and ends with 1; else the counts."""
import argparse
import json
import struct
import sys
from pathlib import Path

ROUNDING_PX = 1e-3    # COCO numbers have three decimals
ROUNDING_SHARE = 2e-6  # YOLO numbers have six


def png_size(path):
    """Width, height, bits of a PNG file, from its header; None when it is none or has no end."""
    content = path.read_bytes()
    if content[:8] != b"\x89PNG\r\n\x1a\n" or content[-8:-4] != b"IEND":
        return None
    return struct.unpack(">IIB", content[16:25])


def unique(entries, what, problems):
    by_id = {}
    for entry in entries:
        if entry["id"] in by_id:
            problems.append(f"{what} id {entry['id']} twice")
        by_id[entry["id"]] = entry
    return by_id


def check_annotation(entry, images, categories, problems):
    name = f"annotation {entry['id']}"
    if entry["category_id"] not in categories:
        problems.append(f"{name}: no category {entry['category_id']}")
    image = images.get(entry["image_id"])
    if image is None:
        problems.append(f"{name}: no image {entry['image_id']}")
        return
    x, y, width, height = entry["bbox"]
    if not (x >= 0 and y >= 0 and width > 0 and height > 0 and x + width <= image["width"] + 1e-6
            and y + height <= image["height"] + 1e-6):
        problems.append(f"{name}: box {entry['bbox']} is not inside {image['width']} x {image['height']}")
    if abs(entry["area"] - width * height) > ROUNDING_PX:
        problems.append(f"{name}: area {entry['area']} is not {width} x {height}")


def check_labels(folder, image, annotations, problems):
    """The YOLO file of an image says what its annotations say."""
    path = folder / "labels" / (Path(image["file_name"]).stem + ".txt")
    rows = [line.split() for line in path.read_text().splitlines()]
    if len(rows) != len(annotations):
        problems.append(f"{path}: {len(rows)} labels, {len(annotations)} annotations")
        return
    for row, annotation in zip(rows, annotations):
        cx, cy, w, h = (float(value) for value in row[1:])
        inside = all(0 <= value <= 1 for value in (cx, cy, w, h)) and cx - w / 2 >= -ROUNDING_SHARE \
            and cx + w / 2 <= 1 + ROUNDING_SHARE and cy - h / 2 >= -ROUNDING_SHARE and cy + h / 2 <= 1 + ROUNDING_SHARE
        if not inside:
            problems.append(f"{path}: {' '.join(row)} is not within [0, 1]")
        x, y, width, height = annotation["bbox"]
        expected = ((x + width / 2) / image["width"], (y + height / 2) / image["height"], width / image["width"],
                    height / image["height"])
        if int(row[0]) != annotation["category_id"] or max(abs(a - b) for a, b in zip((cx, cy, w, h), expected)) > 5e-6:
            problems.append(f"{path}: {' '.join(row)} is not annotation {annotation['id']}")


def check_pictures(folder, image, problems):
    for kind, bits in (("images", 8), ("radiometric", 16)):
        path = folder / kind / Path(image["file_name"]).name
        if kind == "radiometric" and not path.exists():
            continue
        if not path.exists() or png_size(path) != (image["width"], image["height"], bits):
            problems.append(f"{path}: not a picture of {image['width']} x {image['height']} with {bits} bits")


def check(folder):
    """Problems in words, and counts."""
    problems = []
    document = json.loads((folder / "annotations.json").read_text())
    categories = unique(document["categories"], "category", problems)
    images = unique(document["images"], "image", problems)
    unique(document["annotations"], "annotation", problems)
    of_image = {identifier: [] for identifier in images}
    for entry in document["annotations"]:
        check_annotation(entry, images, categories, problems)
        of_image.get(entry["image_id"], []).append(entry)
    for identifier, image in images.items():
        check_labels(folder, image, of_image[identifier], problems)
        check_pictures(folder, image, problems)
    parts = {part: (folder / f"{part}.txt").read_text().split() for part in ("train", "val", "test")}
    for part, names in parts.items():
        if names != ["./" + image["file_name"] for image in images.values() if image["split"] == part]:
            problems.append(f"{part}.txt does not list the images of its part")
    card = json.loads((folder / "card.json").read_text())
    for part, names in parts.items():
        boxes = sum(entry["boxes"][part] for entry in card["classes"].values())
        annotated = sum(len(of_image[i]) for i, image in images.items() if image["split"] == part)
        if card["frames"][part] != len(names) or boxes != annotated:
            problems.append(f"card.json: counts of {part} are not those of the files")
    return problems, {"images": len(images), "labels": len(document["annotations"]), **{p: len(n) for p, n in parts.items()}}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    problems, counts = check(parser.parse_args().folder)
    for problem in problems:
        print(problem)
    print(", ".join(f"{count} {what}" for what, count in counts.items()))
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
