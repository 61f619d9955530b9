#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The thermal dataset of a whole run is one that can be trained on, and the check that says so sees what is wrong with others."""
import json
import shutil
import sys
from pathlib import Path

from whole_run import WholeRun, run

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
import check_dataset  # noqa: E402  pylint: disable=wrong-import-position


class Dataset(WholeRun):
    def damaged(self, change):
        """Problems of a copy of the dataset after `change(folder, document)`; what it does to the document is written back."""
        folder = self.fresh("damaged")
        shutil.copytree(self.reference_out / "thermal", folder)
        document = json.loads((folder / "annotations.json").read_text())
        change(folder, document)
        (folder / "annotations.json").write_text(json.dumps(document))
        return " ".join(check_dataset.check(folder)[0])

    def test_of_a_run(self):
        problems, counts = check_dataset.check(self.reference_out / "thermal")
        self.assertEqual(problems, [])
        self.assertGreater(counts["images"], 50)
        self.assertGreater(counts["labels"], counts["images"])
        self.assertTrue((self.reference_out / "thermal/contact_sheet.png").stat().st_size > 10000)

    def test_the_check_sees_what_is_wrong(self):
        def edit(list_name, index, **values):
            return lambda folder, document: document[list_name][index].update(values)

        def label(text):
            def change(folder, document):
                (folder / "labels" / (Path(document["images"][0]["file_name"]).stem + ".txt")).write_text(text)
            return change

        def cut(folder, document):
            path = folder / document["images"][0]["file_name"]
            path.write_bytes(path.read_bytes()[:-20])

        self.assertIn("id 2 twice", self.damaged(edit("annotations", 0, id=2)))
        self.assertIn("no category 99", self.damaged(edit("annotations", 0, category_id=99)))
        self.assertIn("no image 999999", self.damaged(edit("annotations", 0, image_id=999999)))
        self.assertIn("is not inside", self.damaged(edit("annotations", 0, bbox=[600, 100, 41, 10], area=410)))
        self.assertIn("area 1 is not", self.damaged(edit("annotations", 0, area=1)))
        self.assertIn("does not list", self.damaged(edit("images", 0, split="other")))
        self.assertIn("labels,", self.damaged(label("2 0.5 0.5 0.1 0.1\n" * 99)))
        self.assertIn("not a picture", self.damaged(cut))


run(Dataset, "dataset", __doc__)
