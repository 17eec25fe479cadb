# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees under construction, and what they are compiled to."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from photon_maps_native import Material
from photon_maps_native.shader import Op

from tests.blender.scenes import use_nodes


class Tree:
    """A material, or another tree of shader nodes, under construction."""

    def __init__(self, name="Material", owner=None):
        self.owner = owner or bpy.data.materials.new(name)
        use_nodes(self.owner)
        self.tree = self.owner.node_tree
        self.tree.nodes.clear()
        self.output = self.add("OutputWorld" if isinstance(self.owner, bpy.types.World) else "OutputMaterial")

    @property
    def material(self):
        return self.owner

    def add(self, kind, **inputs):
        node = self.tree.nodes.new(kind if kind.startswith("Node") else f"ShaderNode{kind}")
        for name, value in inputs.items():
            node.inputs[name.replace("_", " ")].default_value = value
        return node

    def link(self, node, socket, output=0):
        self.tree.links.new(node.outputs[output], socket)
        return self

    def surface(self, node, output=0):
        return self.link(node, self.output.inputs["Surface"], output)

    def shine(self, node, output=0):
        """Let an output be the colour of an Emission that is the surface."""
        emission = self.add("Emission")
        return self.link(node, emission.inputs["Color"], output).surface(emission)


def group(name, inputs=(), outputs=()):
    """Return a new group of shader nodes with sockets (name, type), its input node and its output node."""
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for in_out, sockets in (("INPUT", inputs), ("OUTPUT", outputs)):
        for socket, kind in sockets:
            tree.interface.new_socket(socket, in_out=in_out, socket_type=f"NodeSocket{kind}")
    return tree, tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")


@dataclass(frozen=True)
class Step:
    """One instruction of a program."""

    op: Op
    option: int
    shift: int
    arguments: tuple  #: a tuple of three numbers where it is constant, else the Step that computes it


def steps(material: Material) -> list[Step]:
    """Return the instructions of a program in their order, each with its arguments."""
    found: list[Step] = []
    writers: dict[int, Step] = {}

    def argument(register: int):
        if register < len(material.constants):
            return tuple(float(value) for value in material.constants[register])
        return writers[max(first for first in writers if first <= register)]

    for op, option, shift, output, first, count in material.instructions.tolist():
        registers = material.arguments[first : first + count].tolist()
        step = Step(Op(op), option, shift, tuple(argument(register) for register in registers))
        found.append(step)
        if op < Op.DIFFUSE:
            writers[output] = step
    return found


def closures(material: Material) -> list[Step]:
    """Return the closures of a program."""
    return [step for step in steps(material) if step.op >= Op.DIFFUSE]


def weight(material: Material, op: Op) -> np.ndarray:
    """Return the sum of the constant weights of all closures of one kind."""
    return np.sum([np.zeros(3), *(step.arguments[0] for step in closures(material) if step.op == op)], axis=0)
