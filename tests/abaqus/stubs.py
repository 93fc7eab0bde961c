"""Reads abqpy's stubs of the ABAQUS scripting interface with `ast` into the table that drives the recording fake.

Every class with its bases, its methods with their signatures, its attributes with their types; every constant; the
functions of the modules that scripts import. Nothing of it is written by hand, so that a name the fake knows is a name
the stubs know.

    python stubs.py SITE_PACKAGES TABLE.json
"""

from __future__ import annotations

import ast
import json
import sys
from functools import cached_property
from pathlib import Path

Key = str


class Module:
    """One stub file: its classes, functions and what its names refer to."""

    def __init__(self, name: str, path: Path):
        self.name, self.path = name, path
        self.tree = ast.parse(path.read_text(encoding="utf-8"))

    @cached_property
    def imports(self) -> dict[str, tuple[str, str]]:
        """Local name to (module, name there), imports inside functions and type checks included."""
        found = {}
        for node in ast.walk(self.tree):
            if not isinstance(node, ast.ImportFrom):
                continue
            package = self.name.split(".")[: -node.level] if node.level else []
            module = ".".join([*package, *(node.module or "").split(".")]).strip(".")
            for alias in node.names:
                found[alias.asname or alias.name] = (module, alias.name)
        return found

    @cached_property
    def classes(self) -> dict[str, ast.ClassDef]:
        return {node.name: node for node in self.tree.body if isinstance(node, ast.ClassDef)}

    @cached_property
    def functions(self) -> dict[str, list[ast.FunctionDef]]:
        found: dict[str, list[ast.FunctionDef]] = {}
        for node in self.tree.body:
            if isinstance(node, ast.FunctionDef):
                found.setdefault(node.name, []).append(node)
        return found


class Stubs:
    """All stub files below `abaqus`."""

    def __init__(self, site: Path):
        self.site = site
        self.modules = {}
        for path in sorted((site / "abaqus").rglob("*.py")):
            name = ".".join(path.relative_to(site).with_suffix("").parts).removesuffix(".__init__")
            self.modules[name] = Module(name, path)

    def resolve(self, module: str, name: str, depth: int = 0) -> Key | None:
        """The key of the class that a name means in a module."""
        here = self.modules.get(module)
        if here is None or depth > 8:
            return None
        if name in here.classes:
            return f"{module}:{name}"
        if name in here.imports:
            return self.resolve(*here.imports[name], depth + 1)
        return None

    def mentioned(self, module: str, annotation: ast.expr | None) -> list[Key]:
        """Classes that an annotation mentions, in order."""
        if annotation is None:
            return []
        found = []
        for node in ast.walk(annotation):
            name = node.id if isinstance(node, ast.Name) else None
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.isidentifier():
                name = node.value
            key = self.resolve(module, name) if name else None
            if key:
                found.append(key)
        return found

    def table(self) -> dict:
        classes = {}
        for module in self.modules.values():
            for name, node in module.classes.items():
                classes[f"{module.name}:{name}"] = self._class(module.name, node)
        return {"classes": classes, "constants": self.constants(), "modules": self.entries(), "gui": self.gui_names()}

    def constants(self) -> list[str]:
        """Names in abaqusConstants."""
        tree = self.modules["abaqus.UtilityAndView.abaqusConstants"].tree
        return sorted(_assigned(tree))

    def gui_names(self) -> dict[str, str | None]:
        """What abaqusGui exports: classes by key, functions and numbers as None."""
        found: dict[str, str | None] = {}
        for module in self.modules.values():
            if not module.name.startswith("abaqus.PlugInRegistration."):
                continue
            found.update({name: f"{module.name}:{name}" for name in module.classes})
            found.update(dict.fromkeys(module.functions))
            found.update(dict.fromkeys(_assigned(module.tree)))
        return found

    def entries(self) -> dict[str, dict]:
        """Functions of the modules that scripts import, by module, name and signatures."""
        wanted = {
            "abaqus": ["abaqus.UtilityAndView.Status", "abaqus.UtilityAndView.User"],
            "odbAccess": ["abaqus.Odb.OdbCommands"],
            "abaqusGui": [m for m in self.modules if m.startswith("abaqus.PlugInRegistration.")],
        }
        found = {}
        for module, sources in wanted.items():
            found[module] = {}
            for source in sources:
                for name, nodes in self.modules[source].functions.items():
                    found[module][name] = self._signatures(source, nodes, bound=False)
        return found

    def _class(self, module: str, node: ast.ClassDef) -> dict:
        methods: dict[str, list[ast.FunctionDef]] = {}
        attributes = {}
        for item in node.body:
            if isinstance(item, ast.FunctionDef):
                methods.setdefault(item.name, []).append(item)
            elif isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name):
                attributes[item.target.id] = {
                    "type": ast.unparse(item.annotation),
                    "classes": self.mentioned(module, item.annotation),
                }
            elif isinstance(item, ast.Assign):
                for target in item.targets:
                    if isinstance(target, ast.Name):
                        attributes[target.id] = {"type": "", "classes": []}
        properties = [
            name
            for name, nodes in methods.items()
            if any("property" in ast.unparse(d) for n in nodes for d in n.decorator_list)
        ]
        for name in properties:
            returns = methods.pop(name)[0].returns
            attributes[name] = {
                "type": ast.unparse(returns) if returns else "",
                "classes": self.mentioned(module, returns),
            }
        return {
            "name": node.name,
            "bases": [key for base in node.bases for key in self.mentioned(module, base)],
            "methods": {name: self._signatures(module, nodes, bound=True) for name, nodes in methods.items()},
            "attributes": attributes,
        }

    def _signatures(self, module: str, nodes: list[ast.FunctionDef], bound: bool) -> list[dict]:
        """The overloads where there are any, else the function itself."""
        overloads = [n for n in nodes if any("overload" in ast.unparse(d) for d in n.decorator_list)]
        static = any("staticmethod" in ast.unparse(d) for n in nodes for d in n.decorator_list)
        stored = next((s for n in nodes if (s := self._stored(module, n))), None)
        returns = [key for n in reversed(nodes) for key in self.mentioned(module, n.returns)]
        found = []
        for node in overloads or nodes[-1:]:
            args = node.args
            positional = [*args.posonlyargs, *args.args][0 if static or not bound else 1 :]
            defaults = len(args.defaults)
            params = [self._param(a, i >= len(positional) - defaults, False) for i, a in enumerate(positional)]
            params += [
                self._param(a, d is not None, True) for a, d in zip(args.kwonlyargs, args.kw_defaults, strict=True)
            ]
            found.append(
                {
                    "params": params,
                    "more": args.vararg is not None,
                    "any": args.kwarg is not None,
                    "returns": returns,
                    "stored": stored,
                }
            )
        return found

    def _param(self, arg: ast.arg, optional: bool, keyword_only: bool) -> dict:
        annotation = arg.annotation
        literal = None
        if annotation is not None:
            for node in ast.walk(annotation):
                if isinstance(node, ast.Subscript) and ast.unparse(node.value) == "Literal":
                    items = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
                    names = [i.attr for i in items if isinstance(i, ast.Attribute)]
                    literal = (literal or []) + names
        return {
            "name": arg.arg,
            "optional": optional,
            "keyword_only": keyword_only,
            "type": ast.unparse(annotation) if annotation is not None else "",
            "literal": literal,
        }

    def _stored(self, module: str, node: ast.FunctionDef) -> list | None:
        """[repository, class] where the body puts a new object into a repository: `self.parts[name] = part = Part(...)`."""
        for item in ast.walk(node):
            if not (isinstance(item, ast.Assign) and isinstance(item.value, ast.Call)):
                continue
            for target in item.targets:
                if isinstance(target, ast.Subscript) and ast.unparse(target.value).startswith("self."):
                    function = item.value.func
                    key = self.resolve(module, function.id) if isinstance(function, ast.Name) else None
                    if key:
                        return [ast.unparse(target.value)[5:], key]
        return None


def _assigned(tree: ast.Module) -> set[str]:
    names = set()
    for node in ast.walk(tree):
        targets = node.targets if isinstance(node, ast.Assign) else []
        if isinstance(node, ast.AnnAssign):
            targets = [node.target]
        names.update(t.id for t in targets if isinstance(t, ast.Name))
    return names


def main() -> None:
    """Writes the table."""
    site, out = map(Path, sys.argv[1:])
    out.write_text(json.dumps(Stubs(site).table(), indent=0), encoding="utf-8")


if __name__ == "__main__":
    main()
