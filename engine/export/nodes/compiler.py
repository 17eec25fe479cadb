# SPDX-License-Identifier: GPL-3.0-or-later
"""From a tree of nodes to a flat program: each output is computed once, closures are found from the top down."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import bpy
import numpy as np
from photon_maps_native.shader import Input, Math, Op, Register, Shader

from ...messages import Messages
from ..resources import Resources
from . import registry
from .averages import unknown_value
from .closures import nearest_closure
from .fold import fold
from .tree import Port, find_socket, source

#: Registers, constants included, and closures that a program may have.
MAX_REGISTERS = 1000
#: Constants beyond this are refused by the helper.
MAX_CONSTANT = 1e15

CONSTANT_NODES = {"ShaderNodeRGB", "ShaderNodeValue"}
_KINDS = {"VALUE": "VALUE", "INT": "VALUE", "BOOLEAN": "VALUE", "VECTOR": "VECTOR", "ROTATION": "VECTOR"}


class ProgramTooLong(Exception):
    """A program has more registers or closures than the helper takes."""


def kind_of(socket: bpy.types.NodeSocket) -> str:
    """Return VALUE, VECTOR, RGBA or SHADER, or another type of sockets that hold no numbers."""
    return _KINDS.get(socket.type, socket.type)


class Compiler:
    """Compiles one material, world or lamp."""

    def __init__(
        self,
        owner: str,
        resources: Resources,
        messages: Messages,
        is_world: bool = False,
        is_constant: bool = False,
    ) -> None:
        """
        :param owner: name of the material, world or light, for the messages.
        :param is_world: geometric inputs are directions, and there are no attributes.
        :param is_constant: what nodes compute is replaced by the sockets' own values.
        """
        self.owner = owner
        self.resources = resources
        self.messages = messages
        self.is_world = is_world
        self.is_constant = is_constant
        self.shader = Shader()
        self._groups: tuple[bpy.types.Node, ...] = ()  # that the node being compiled stands in
        self._shift = 0
        self._outputs = 0
        self.closures: list[tuple[Op, tuple[Register, ...]]] = []  #: that were compiled, and their arguments
        self._constants: dict[Register, np.ndarray] = {}
        self._emitted: dict[tuple, Register] = {}
        self._results: dict[tuple, dict[str, Register]] = {}

    # --- Registers ---

    def constant(self, value: float | Sequence[float]) -> Register:
        """Return a register that holds a number, or three of them; what the helper would refuse is named."""
        wanted = np.broadcast_to(np.asarray(value, np.float64), 3)
        held = np.clip(np.nan_to_num(wanted, nan=0.0), -MAX_CONSTANT, MAX_CONSTANT)
        if not np.array_equal(wanted, held):
            text = f"has a number that is beyond {MAX_CONSTANT:g} or none at all; it is clamped."
            self.messages.add(self.owner, text, "Correct the values of its nodes.")
        register = self.shader.constant(held)
        self._constants[register] = held
        self._check_length()
        return register

    def known(self, register: Register) -> np.ndarray | None:
        """Return the (3,) float64 that a register always holds, if it does."""
        return self._constants.get(register)

    def is_zero(self, register: Register) -> bool:
        """Return whether a register is known to hold zeros."""
        value = self.known(register)
        return value is not None and not value.any()

    def emit(self, op: Op, *arguments: Register, option: int = 0, outputs: int = 1) -> Register:
        """Append an operation, or find it where it was done before.

        :return: the first of the registers that it writes.
        """
        values = [self._constants.get(argument) for argument in arguments]
        if arguments and outputs == 1 and all(value is not None for value in values):
            result = fold(op, option, values)
            if result is not None:
                return self.constant(result)
        shift = self._shift if op in {Op.INPUT, Op.ATTRIBUTE} else 0
        key = (op, option, shift, arguments)
        if key not in self._emitted:
            register = self.shader.add(op, *arguments, option=option, shift=shift, outputs=outputs)
            self._outputs += outputs
            self._check_length()
            self._emitted[key] = register
        return self._emitted[key]

    def input(self, value: Input) -> Register:
        """Return a register with what is known of the point and the ray."""
        return self.emit(Op.INPUT, option=value)

    def attribute(self, kind: str, name: str = "") -> Register:
        """Return the first of two registers with an attribute and its alpha; see Resources."""
        return self.emit(Op.ATTRIBUTE, option=self.resources.attribute(kind, name), outputs=2)

    def generated(self) -> Register:
        """Return the generated coordinates; in a world the direction, as in Cycles."""
        return self.input(Input.POSITION) if self.is_world else self.attribute("generated")

    def math(self, operation: Math, *arguments: Register) -> Register:
        """Return the result of an operation on each component."""
        return self.emit(Op.MATH, *arguments, option=operation)

    def multiply(self, a: Register, b: Register) -> Register:
        """Return a product; by what is known to be 0 or 1 it costs nothing."""
        for factor, other in ((a, b), (b, a)):
            value = self.known(factor)
            if value is not None and (value == 1.0).all():
                return other
            if value is not None and not value.any():
                return factor
        return self.math(Math.MULTIPLY, a, b)

    def clamp(self, value: Register) -> Register:
        """Return a value clamped to 0 ... 1."""
        return self.emit(Op.CLAMP, value, self.constant(0.0), self.constant(1.0))

    def component(self, vector: Register, index: int) -> Register:
        """Return one component of a vector as a number."""
        return self.emit(Op.COMPONENT, vector, option=index)

    def convert(self, register: Register, origin: str, target: str) -> Register:
        """Return a value of one kind of sockets as Blender reads it in another's."""
        if target != "VALUE" or origin == "VALUE":
            return register
        return self.emit(Op.LUMINANCE if origin == "RGBA" else Op.AVERAGE, register)

    # --- What node functions ask ---

    def has_input(self, node: bpy.types.Node, identifier: str) -> bool:
        """Return whether this Blender's node has an input."""
        return find_socket(node.inputs, identifier) is not None

    def is_linked(self, node: bpy.types.Node, identifier: str) -> bool:
        """Return whether another node computes an input."""
        return self._origin(node, identifier)[0].socket.is_output

    def value(self, node: bpy.types.Node, identifier: str, absent: float | Sequence[float] = 0.0) -> Register:
        """Return the value of an input, as the input's type has it; `absent` where this Blender does not have it."""
        if not self.has_input(node, identifier):
            return self.constant(absent)
        return self._register(*self._origin(node, identifier))

    def value_or(self, node: bpy.types.Node, identifier: str, default: Callable[[], Register]) -> Register:
        """Return the value of an input whose own value has no meaning, or the default where it is not linked."""
        if not self.has_input(node, identifier) or not self.is_linked(node, identifier):
            return default()
        return self.value(node, identifier)

    def normal(self, node: bpy.types.Node, identifier: str = "Normal") -> Register:
        """Return the normal that arrives at an input, or the shading normal."""
        return self.value_or(node, identifier, lambda: self.input(Input.NORMAL))

    @contextmanager
    def shifted(self, shift: int) -> Iterator[None]:
        """Compile what follows for a point a step along the surface (1 or 2), for bump mapping."""
        before, self._shift = self._shift, shift
        try:
            yield
        finally:
            self._shift = before

    def name(self, node: bpy.types.Node, text: str, advice: str = "") -> None:
        """Add a message about a node of the owner."""
        name = node.label or node.name
        kind = "" if node.bl_label in name else f" ({node.bl_label})"
        self.messages.add(self.owner, text, advice, node=f'"{name}"{kind}')

    # --- Closures ---

    def surface(self, node: bpy.types.Node, identifier: str, weight: Register) -> None:
        """Compile the closures that arrive at a shader input, times a weight."""
        if self.is_zero(weight):
            return
        origin, passed = self._origin(node, identifier)
        if not origin.socket.is_output:
            return
        if kind_of(origin.socket) != "SHADER":  # Blender turns a colour in a shader socket into emission
            self.closure(Op.EMISSION, self.multiply(weight, self.radiance(node, self._register(origin, passed))))
            return
        with self._inside(origin.groups):
            registry.CLOSURES.get(origin.node.bl_idname, nearest_closure)(self, origin.node, weight)

    def closure(self, op: Op, weight: Register, *arguments: Register, option: int = 0) -> None:
        """Append a closure, unless its weight is zero."""
        if self.is_zero(weight):
            return
        self.closures.append((op, (weight, *arguments)))
        self.shader.close(op, weight, *arguments, option=option)
        self._check_length()

    def radiance(self, node: bpy.types.Node, register: Register) -> Register:
        """Return a radiance; one that is constant and negative is named and clamped."""
        value = self.known(register)
        if value is None or (value >= 0.0).all():
            return register
        self.name(node, "has a negative emission; it is 0.", "Correct its colour or strength.")
        return self.constant(np.maximum(value, 0.0))

    # --- Inside ---

    def _origin(self, node: bpy.types.Node, identifier: str) -> tuple[Port, list[bpy.types.NodeSocket]]:
        socket = find_socket(node.inputs, identifier)
        origin, passed = source(Port(socket, self._groups))
        is_computed = origin.socket.is_output and kind_of(origin.socket) != "SHADER"
        if self.is_constant and is_computed and origin.node.bl_idname not in CONSTANT_NODES:
            return Port(socket, self._groups), []
        return origin, passed

    def _register(self, origin: Port, passed: Sequence[bpy.types.NodeSocket]) -> Register:
        kind = kind_of(origin.socket)
        register = self._output(origin) if origin.socket.is_output else self._own_value(origin.socket)
        for socket in reversed(passed):
            register, kind = self.convert(register, kind, kind_of(socket)), kind_of(socket)
        return register

    def _own_value(self, socket: bpy.types.NodeSocket) -> Register:
        value = getattr(socket, "default_value", 0.0)
        if isinstance(value, (bool, int, float)):
            return self.constant(float(value))
        if isinstance(value, str):
            return self.constant(0.0)
        return self.constant([*value, 0.0, 0.0][:3])  # vectors may have two components, colours have four

    def _output(self, port: Port) -> Register:
        """Return the register of an output, compiling its node the first time."""
        # What it needs comes first, from a list: trees may be deeper than Python's stack.
        pending = [port]
        while pending:
            upstream = [] if self._key(pending[-1]) in self._results else self._needed(pending[-1])
            if not upstream:
                self._compile(pending.pop())
            pending += upstream
        results = self._results[self._key(port)]
        if port.socket.identifier not in results:
            self.name(port.node, f'has an output "{port.socket.name}" that is not supported; it is 0.')
            results[port.socket.identifier] = self.constant(0.0)
        return results[port.socket.identifier]

    def _key(self, port: Port) -> tuple[int, ...]:
        return (*(group.as_pointer() for group in port.groups), port.node.as_pointer(), self._shift)

    def _needed(self, port: Port) -> list[Port]:
        """Return outputs that a node's inputs come from and that are not compiled yet."""
        if port.node.bl_idname not in registry.VALUES or port.node.bl_idname in registry.REPLACED:
            return []
        linked = [socket for socket in port.node.inputs if socket.enabled and socket.is_linked]
        origins = [source(Port(socket, port.groups))[0] for socket in linked]
        values = [origin for origin in origins if origin.socket.is_output and kind_of(origin.socket) != "SHADER"]
        return [origin for origin in values if self._key(origin) not in self._results]

    def _compile(self, port: Port) -> None:
        key = self._key(port)
        if key not in self._results:
            with self._inside(port.groups):
                self._results[key] = registry.VALUES.get(port.node.bl_idname, unknown_value)(self, port.node)

    @contextmanager
    def _inside(self, groups: tuple[bpy.types.Node, ...]) -> Iterator[None]:
        before, self._groups = self._groups, groups
        try:
            yield
        finally:
            self._groups = before

    def _check_length(self) -> None:
        if max(len(self._constants) + self._outputs, len(self.closures)) > MAX_REGISTERS:
            raise ProgramTooLong(self.owner)
