"""Names of the rows of matrices in coordinate form, which have no nodes of their own."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from .._errors import StudyError, complaint
from ._points import Dof, dof_of

__all__ = ["Rows"]

MOST_DIRECTIONS = 6


class Rows:
    """Degrees of freedom of the rows of a matrix: stated, or a number of directions of each node in order."""

    def __init__(self, dofs: object = None, nodes: object = None, directions: object = None, per_node: bool = False) -> None:
        """``dofs`` are nodes with directions, or ``nodes`` of every block of ``directions`` rows [default: 1, 2, 3, …].

        ``per_node``: the nodes are those of all blocks, so that the number of rows says how many each has.

        Raises
        ------
        quell.StudyError
            An argument that is wrong.
        """
        self.dofs = None if dofs is None else rows_of(dofs)
        self.nodes = None if nodes is None else nodes_of(nodes)
        self.directions = directions
        self.is_given = not (dofs is None and nodes is None and directions is None)
        """Whether the caller names the rows."""
        self.made: list[Dof] | None = None
        wrong = directions is not None and (not isinstance(directions, int) or isinstance(directions, bool) or not 1 <= directions <= MOST_DIRECTIONS)
        if wrong:
            raise StudyError([complaint("directions", directions, "a number of directions of each node, from 1 to 6")])
        if dofs is not None and (nodes is not None or directions is not None):
            name = "directions" if nodes is None else "nodes"
            raise StudyError([complaint(name, None, "left out: dofs has the nodes and directions of all rows", "conflict")])
        self.per_node = per_node and self.nodes is not None
        if nodes is not None and directions is None and not per_node:
            raise StudyError([complaint("directions", None, "given: the number of rows of each node, such as 3", "missing")])

    def named(self, count: int, where: str) -> list[Dof]:
        """The degrees of freedom of the rows of a matrix; another matrix of the structure may end earlier, where rows are zero.

        Raises
        ------
        quell.StudyError
            They are not stated, or are of another number of rows.
        """
        if self.made is None:
            self.made = self._named(count, where)
        if count > len(self.made):
            raise StudyError([complaint("stiffness", f"{len(self.made)} rows", f"as large as {where}, which has {count} rows", "conflict")])
        return self.made

    def _named(self, count: int, where: str) -> list[Dof]:
        """The degrees of freedom of the rows of the first matrix."""
        if self.dofs is not None:
            if len(self.dofs) != count:
                raise StudyError([complaint("dofs", f"{len(self.dofs)} rows", f"the {count} rows of {where}")])
            return self.dofs
        if self.directions is None and self.per_node and self.nodes:
            each, left = divmod(count, len(self.nodes))
            if left or not 1 <= each <= MOST_DIRECTIONS:
                allowed = f"that of the nodes of {where}: {count} rows are not 1 to 6 of each of {len(self.nodes)} nodes"
                raise StudyError([complaint("mapping", f"{len(self.nodes)} nodes", allowed)])
            self.directions = each
        if not isinstance(self.directions, int):
            allowed = f"given: {where} has {count} rows without nodes. dofs names them one by one"
            ways = [f"directions={each} those of {count // each} nodes in order" for each in (3, 6) if count % each == 0]
            allowed += f", or {' and '.join(ways)}" if ways else ""
            raise StudyError([complaint("dofs", None, allowed, "missing")])
        if count % self.directions:
            raise StudyError([complaint("directions", self.directions, f"a divisor of the {count} rows of {where}")])
        nodes = list(range(1, count // self.directions + 1)) if self.nodes is None else self.nodes
        if len(nodes) * self.directions != count:
            allowed = f"those of the {count} rows of {where}, {count // self.directions} with {self.directions} directions each"
            raise StudyError([complaint("nodes", f"{len(nodes)} nodes", allowed)])
        return [(node, direction) for node in nodes for direction in range(1, self.directions + 1)]


def rows_of(dofs: object) -> list[Dof]:
    """Nodes and directions of rows."""
    allowed = "nodes and directions of all rows, such as [(1, 1), (1, 2)]"
    if not isinstance(dofs, Iterable):
        raise StudyError([complaint("dofs", dofs, allowed)])
    found = [(given, dof_of(given)) for given in dofs]
    wrong = [complaint(f"dofs[{place}]", given, "a node and a direction") for place, (given, dof) in enumerate(found) if dof is None]
    if wrong:
        raise StudyError(wrong)
    made = [dof for _, dof in found if dof is not None]
    if twice := [dof for place, dof in enumerate(made) if dof in set(made[:place])] if len(set(made)) < len(made) else []:
        raise StudyError([complaint("dofs", twice[0], "each node and direction once")])
    return made


def nodes_of(nodes: object) -> list[int]:
    """The node of every block of rows."""
    if not isinstance(nodes, (Sequence, np.ndarray)) or isinstance(nodes, str):
        raise StudyError([complaint("nodes", nodes, "the nodes of all blocks of rows, such as [3, 31, 17]")])
    wrong = [place for place, node in enumerate(nodes) if isinstance(node, bool) or not isinstance(node, (int, np.integer))]
    if wrong:
        raise StudyError([complaint(f"nodes[{wrong[0]}]", nodes[wrong[0]], "the number of a node")])
    found = [int(node) for node in nodes]
    if len(set(found)) < len(found):
        twice = next(node for place, node in enumerate(found) if node in found[:place])
        raise StudyError([complaint("nodes", twice, "each node once")])
    return found
