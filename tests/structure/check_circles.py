"""Checks that nothing goes round in a circle: headers with their sources, the modules of the Python package.

A header and its source are one unit, so that a source that includes what includes its header is a circle too. In the
Python package an import that is hidden in a function, to break a circle, counts as any other.
"""

import ast

import check_includes
import tree


def unit(path):
    return str(path.with_suffix(""))


def include_graph(root):
    """{unit: {unit that it includes: "file:line"}} of the rooms."""
    graph = {}
    for path in tree.project_files(root, {".hpp", ".cpp"}):
        relative = path.relative_to(root)
        if relative.parts[0] not in tree.ROOMS:
            continue
        users = graph.setdefault(unit(relative), {})
        for number, name, _ in check_includes.includes(path):
            included = name.rsplit(".", 1)[0]
            if name.split("/")[0] in tree.ROOMS and included != unit(relative):
                users.setdefault(included, f"{relative}:{number}")
    return graph


def imported(node, package):
    """The modules of the package that an import names."""
    if isinstance(node, ast.ImportFrom) and node.level == 1:
        return [node.module.split(".")[0]] if node.module else [alias.name for alias in node.names]
    if isinstance(node, ast.Import):
        return [alias.name.split(".")[1] for alias in node.names if alias.name.startswith(package + ".")]
    return []


def import_graph(root):
    """The same of the Python package, and the complaints about imports in functions."""
    folder = root / "python" / "mpmbench"
    graph, complaints = {}, []
    for path in sorted(folder.glob("*.py")):
        relative = path.relative_to(root)
        modules = graph.setdefault(path.stem, {})
        top = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(top):
            for module in imported(node, folder.name):
                modules.setdefault(module, f"{relative}:{node.lineno}")
                if node not in top.body:
                    complaints.append(f"{relative}:{node.lineno}: the import of {module} is hidden in a function")
    return graph, complaints


def circles(graph):
    """The sets of nodes that reach each other (Tarjan 1972), without those of one node."""
    order, low, stack, found = {}, {}, [], []

    def visit(node):
        order[node] = low[node] = len(order)
        stack.append(node)
        for other in graph.get(node, {}):
            if other not in order:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == order[node]:
            members = stack[stack.index(node):]
            del stack[stack.index(node):]
            if len(members) > 1:
                found.append(members)

    for node in sorted(graph):
        if node not in order:
            visit(node)
    return found


def check(root):
    files, (modules, complaints) = include_graph(root), import_graph(root)
    for graph in (files, modules):
        for members in map(sorted, circles(graph)):
            where = next(where for name, where in graph[members[0]].items() if name in members)
            complaints.append(f"{where}: a circle of {', '.join(members)}")
    return complaints


if __name__ == "__main__":
    tree.main(check)
