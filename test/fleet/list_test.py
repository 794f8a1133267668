"""Lists of bags."""
import pathlib
import tempfile
import unittest

from fleet_support import SOURCE  # noqa: F401  (sets the path)
import bag_list


class Lists(unittest.TestCase):
    def setUp(self):
        self._directory = tempfile.TemporaryDirectory()
        self.addCleanup(self._directory.cleanup)
        self.directory = pathlib.Path(self._directory.name)

    def listed(self, name, text):
        path = self.directory / name
        path.write_text(text)
        return bag_list.read(str(path))

    def test_csv_and_yaml_agree(self):
        as_csv = self.listed("a.csv", "machine,bag,parameters\nred,x.bag,h.yaml;b.yaml\nblue,/abs/y.bag,\n")
        as_yaml = self.listed("a.yaml", "- {machine: red, bag: x.bag, parameters: [h.yaml, b.yaml]}\n"
                                        "- {machine: blue, bag: /abs/y.bag}\n")
        self.assertEqual(as_csv, as_yaml)
        self.assertEqual(as_csv[0].bag, str(self.directory / "x.bag"))
        self.assertEqual(as_csv[0].parameters, (str(self.directory / "h.yaml"), str(self.directory / "b.yaml")))
        self.assertEqual(as_csv[1].bag, "/abs/y.bag")

    def test_a_folder_is_a_list_of_bags(self):
        for machine, files in (("red", ("1.bag", "2.bag.active", "h.yaml", "notes.txt")), ("blue", ("1.bag",))):
            (self.directory / machine).mkdir()
            for name in files:
                (self.directory / machine / name).write_text("")
        bags = bag_list.read(str(self.directory))
        self.assertEqual([(b.machine, pathlib.Path(b.bag).name, len(b.parameters)) for b in bags],
                         [("blue", "1.bag", 0), ("red", "1.bag", 1), ("red", "2.bag.active", 1)])
        self.assertEqual(len({bag.name for bag in bags}), 3)

    def test_splits_of_one_recording_are_one_bag(self):
        bags = self.listed("a.csv", "machine,bag,parameters\nred,w_0.bag,\nred,w_1.bag,\nblue,w_1.bag,\nred,other.bag,\n")
        asked = []

        def recordings(paths):
            asked.append([pathlib.Path(path).name for path in paths])
            return [sorted(paths)]
        joined = bag_list.joined(bags, recordings)
        self.assertEqual([(b.machine, pathlib.Path(b.bag).name, len(b.later)) for b in joined],
                         [("red", "w_0.bag", 1), ("blue", "w_1.bag", 0), ("red", "other.bag", 0)])
        self.assertEqual(asked, [["w_0.bag", "w_1.bag"]])  # what cannot be a split is not opened
        self.assertEqual(joined[0].name, bags[0].name)

    def test_bad_ones_are_one_line(self):
        for name, text, words in (("a.csv", "bag\nx.bag\n", "machine,bag,parameters"),
                                  ("c.csv", "machine,bag\n", "names no bag"),
                                  ("d.csv", "machine,bag\nred,x.bag\nred,x.bag\n", "twice"),
                                  ("e.yaml", "machine: red\n", "must be a list"),
                                  ("f.yaml", "- {machine: red, bag: \0x}\n", "not valid YAML"),
                                  ("g.yaml", "- [", "not valid YAML")):
            with self.assertRaisesRegex(bag_list.BadList, f"{name}: .*{words}"):
                self.listed(name, text)

    def test_a_bad_entry_is_a_row_with_its_reason(self):
        bags = self.listed("a.yaml", "- {machine: red, bag: x.bag}\n- 5\n- {machine: red}\n- {machine: 7, bag: 7.5}\n"
                                     "- {machine: [red], bag: x.bag}\n- {machine: red, bag: y.bag, parameters: [1]}\n"
                                     '- {machine: red, bag: "z\\0.bag"}\n- {machine: 7, bag: x.bag}\n')
        self.assertEqual([bag.problem and bag.problem.split(":")[0] for bag in bags[:6]],
                         [None] + [f"entry {i}" for i in range(2, 7)])
        self.assertIn("control characters", bags[6].problem)
        self.assertEqual((bags[7].machine, bags[7].problem), ("7", None))
        self.assertIn("entry 1: machine and bag", self.listed("b.csv", "machine,bag\nred,\n")[0].problem)
        path = self.directory / "c.csv"
        path.write_bytes(b"machine,bag,parameters\nred,x.bag,a\0b.yaml\nr\xff,x.bag,\nred,y\xff.bag,\nred,x.bag,\n")
        bags = bag_list.read(str(path))
        self.assertEqual([bool(bag.problem) for bag in bags], [True, True, True, False])
        for bag in bags:
            for text in (bag.machine, bag.bag, *bag.parameters, bag.problem or ""):
                self.assertEqual(text, bag_list.shown(text.encode("utf-8").decode("utf-8")))

    def test_names_of_pages_differ(self):
        names = ["a b", "a_b", "all", "../x", "a/b", ".."]
        self.assertEqual(len({bag_list.page_name(name) for name in names} | {"all"}), len(names) + 1)
        self.assertFalse([n for n in names if "/" in bag_list.page_name(n)])


if __name__ == "__main__":
    unittest.main()
