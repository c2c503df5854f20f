#!/usr/bin/env python3
"""Measures the structure of the workspace and fails where it breaks a limit.

Counts, per crate: source files, code lines (no tests, comments or blank lines), public items, the largest folder, and
circles: groups of files that import each other (`use crate::…` and inline paths; tests and re-exports left out).

    .ci/structure.py            print the table, then each circle and each folder over the limit
Exit code 1: more circles than CIRCLES_MAX, or a folder with more than FILES_MAX source files.
"""

import re
import subprocess
import sys
from pathlib import Path

CIRCLES_MAX = 0
FILES_MAX = 15

TEST_MODULE = re.compile(r"^( *)#\[cfg\(test\)\]\n(?: *#\[[^\n]*\]\n)* *(?:pub(?:\([a-z]+\))? )?mod (\w+)( \{|;)", re.M)
PATH = re.compile(r"(?<![\w:])(crate|self|super)((?:::\w+)+)")
USE = re.compile(r"^ *(pub(?:\([^)]*\))? )?use ([^;]+);", re.M)
PUBLIC = re.compile(r"^ *pub (?:const |unsafe |async )*(?:fn|struct|enum|trait|type|const|static|mod|union) ", re.M)


def without_tests(text):
    """The text without its `#[cfg(test)]` modules, and the names of those that are files."""
    files = []
    while found := TEST_MODULE.search(text):
        indent, name, kind = found.groups()
        if kind == ";":
            files.append(name)
            end = found.end()
        else:
            end = text.index(f"\n{indent}}}\n", found.end()) + len(indent) + 3
        text = text[: found.start()] + text[end:]
    return text, files


def without_comments(text):
    """The text without comments and blank lines. String literals that hold `//` keep their start."""
    lines = (re.sub(r'(^|[^:"])//.*$', r"\1", line).rstrip() for line in text.split("\n"))
    return "\n".join(line for line in lines if line.strip())


def leaves(tree):
    """`a::{b, c::{d, e}}` as `a::b`, `a::c::d`, `a::c::e`."""
    tree = re.sub(r"\s+", " ", tree).strip()
    if "{" not in tree:
        return [re.sub(r" as \w+$", "", tree)]
    prefix, inner = tree.split("{", 1)
    parts, depth, part = [], 0, ""
    for letter in inner.rsplit("}", 1)[0] + ",":
        depth += (letter == "{") - (letter == "}")
        if letter == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += letter
    return [prefix + leaf for part in parts if part.strip() for leaf in leaves(part)]


class Crate:
    """The modules of one crate: module path (a tuple) → file and code."""

    def __init__(self, source):
        self.files, self.code, self.exports = {}, {}, {}
        texts, tests = {}, set()
        for path in sorted(source.rglob("*.rs")):
            parts = path.relative_to(source).with_suffix("").parts
            module = () if parts in (("lib",), ("main",)) else parts[:-1] if parts[-1] == "mod" else parts
            text, test_files = without_tests(path.read_text(encoding="utf-8"))
            tests.update(module + (name,) for name in test_files)
            texts[module] = path, text
        for module, (path, text) in texts.items():
            if any(module[:length] in tests for length in range(1, len(module) + 1)):
                continue
            self.files[module], self.code[module] = path, without_comments(text)
        for module, code in self.code.items():
            uses = (leaf for public, tree in USE.findall(code) if public for leaf in leaves(tree))
            self.exports[module] = {leaf.split("::")[-1]: self.absolute(leaf, module) for leaf in uses}

    def absolute(self, path, module):
        """The path from the crate's root, as a tuple; none for another crate's."""
        parts = path.split("::")
        if parts[0] == "crate":
            return tuple(parts[1:])
        if parts[0] in ("self", "super"):
            while parts and parts[0] in ("self", "super"):
                module = module[:-1] if parts[0] == "super" else module
                parts = parts[1:]
            return tuple(module) + tuple(parts)
        return tuple(module) + tuple(parts) if module + (parts[0],) in self.files else None

    def module_of(self, path, hops=8):
        """The module that holds what a path names; re-exports are followed."""
        for length in range(len(path), -1, -1):
            module = path[:length]
            if module not in self.files:
                continue
            target = self.exports[module].get(path[length]) if length < len(path) else None
            return self.module_of(target, hops - 1) if target is not None and hops else module
        return None

    def imports(self, module):
        """The modules that a module imports from."""
        code = self.code[module]
        paths = [leaf for public, tree in USE.findall(code) if not public for leaf in leaves(tree)]
        body = USE.sub("", code)
        paths += ["".join(found) for found in PATH.findall(body)]
        absolute = (self.absolute(re.sub(r"::(self|\*)$", "", path), module) for path in paths)
        found = {self.module_of(path) for path in absolute if path is not None}
        return found - {module, None}

    def circles(self):
        """Groups of two or more modules, each of which leads to each other (Tarjan's algorithm)."""
        graph = {module: sorted(self.imports(module)) for module in self.files}
        index, low, stack, groups = {}, {}, [], []

        def visit(module):
            index[module] = low[module] = len(index)
            stack.append(module)
            for other in graph[module]:
                if other not in index:
                    visit(other)
                if other in stack:
                    low[module] = min(low[module], low[other])
            if low[module] == index[module]:
                group = []
                while not group or group[-1] != module:
                    group.append(stack.pop())
                if len(group) > 1:
                    groups.append(sorted(group))

        for module in graph:
            if module not in index:
                visit(module)
        return [[(module, [other for other in graph[module] if other in group]) for module in group] for group in groups]


def main():
    sys.setrecursionlimit(10_000)
    root = Path(subprocess.check_output(["git", "rev-parse", "--show-toplevel"], text=True).strip())
    manifests = subprocess.check_output(["git", "ls-files", "*/Cargo.toml"], cwd=root, text=True).split()
    sources = [root / manifest.replace("Cargo.toml", "src") for manifest in manifests if not manifest.startswith("fuzz")]
    print(f"{'crate':<20}{'files':>7}{'code lines':>12}{'public items':>14}{'largest folder':>16}{'circles':>9}")
    circles, full, lines_in_all, public_in_all = [], [], 0, 0
    for source in sources:
        crate = Crate(source)
        folders = {}
        for path in crate.files.values():
            folders.setdefault(path.parent, []).append(path)
        full += [(folder, len(files)) for folder, files in folders.items() if len(files) > FILES_MAX]
        lines = sum(code.count("\n") + 1 for code in crate.code.values() if code)
        public = sum(len(PUBLIC.findall(code)) for code in crate.code.values())
        found = crate.circles()
        circles += [(source, circle) for circle in found]
        lines_in_all, public_in_all = lines_in_all + lines, public_in_all + public
        largest = max(map(len, folders.values()))
        name = str(source.parent.relative_to(root))
        print(f"{name:<20}{len(crate.files):>7}{lines:>12}{public:>14}{largest:>16}{len(found):>9}")
    print(f"{'all':<20}{'':>7}{lines_in_all:>12}{public_in_all:>14}{'':>16}{len(circles):>9}")
    for source, circle in circles:
        print(f"\ncircle in {source.relative_to(root)}:")
        for module, others in circle:
            print(f"  {'::'.join(module) or 'lib'} → {', '.join('::'.join(other) or 'lib' for other in others)}")
    for folder, count in full:
        print(f"\n{folder.relative_to(root)} holds {count} source files; the limit is {FILES_MAX}")
    return 1 if len(circles) > CIRCLES_MAX or full else 0


if __name__ == "__main__":
    sys.exit(main())
