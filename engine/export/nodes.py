# SPDX-License-Identifier: GPL-3.0-or-later
"""Walking a shader node tree: where a socket's value comes from, through reroutes, groups and muted nodes."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..messages import Messages


@dataclass(frozen=True)
class Port:
    """A socket, and the group nodes it stands in, outermost first."""

    socket: bpy.types.NodeSocket
    groups: tuple[bpy.types.Node, ...] = ()

    @property
    def node(self) -> bpy.types.Node:
        return self.socket.node

    def input(self, name: str) -> Port:
        """Return another input of this port's node, by its name."""
        return Port(self.node.inputs[name], self.groups)

    def input_at(self, index: int) -> Port:
        """Return another input of this port's node, by its position; for nodes whose names are not unique."""
        return Port(self.node.inputs[index], self.groups)


def shader_tree(owner: bpy.types.Material | bpy.types.World) -> bpy.types.NodeTree | None:
    """Return the nodes that a material or world uses, if it does."""
    # From Blender 5.0 on they always do, and asking is deprecated.
    return owner.node_tree if bpy.app.version >= (5, 0, 0) or owner.use_nodes else None


def source(port: Port) -> Port:
    """Follow the links upstream: the output that computes the value, or the unlinked input that holds it."""
    while (upstream := _step(port)) is not None:
        port = upstream
    return port


def _step(port: Port) -> Port | None:
    socket, groups = port.socket, port.groups
    if not socket.is_output:
        # Blender marks links that would close a cycle invalid, so the walk ends.
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
        return Port(link.from_socket, groups) if link else None
    node = socket.node
    if node.mute:
        link = next((link for link in node.internal_links if link.to_socket == socket), None)
        return Port(link.from_socket, groups) if link else None
    if node.bl_idname == "NodeReroute":
        return Port(node.inputs[0], groups)
    if node.bl_idname == "ShaderNodeGroup" and node.node_tree:
        return _into_group(node, socket.identifier, groups)
    if node.bl_idname == "NodeGroupInput" and groups:
        outside = _by_identifier(groups[-1].inputs, socket.identifier)
        return Port(outside, groups[:-1]) if outside else None
    return None


def _into_group(node: bpy.types.Node, identifier: str, groups: tuple[bpy.types.Node, ...]) -> Port | None:
    outputs = [inner for inner in node.node_tree.nodes if inner.bl_idname == "NodeGroupOutput"]
    active = next((inner for inner in outputs if inner.is_active_output), None)
    socket = _by_identifier(active.inputs, identifier) if active else None
    return Port(socket, (*groups, node)) if socket else None


def _by_identifier(sockets: bpy.types.NodeInputs, identifier: str) -> bpy.types.NodeSocket | None:
    return next((socket for socket in sockets if socket.identifier == identifier), None)


class ConstantReader:
    """Reads sockets as constants; what is not constant is replaced by the socket's own value and named."""

    def __init__(self, owner: str, messages: Messages) -> None:
        self.owner = owner  #: name of the material, world or light
        self.messages = messages

    def color(self, port: Port) -> np.ndarray:
        """Return the linear RGB of a colour or number socket as (3,) float64."""
        value = self._value(port)
        return np.array(value[:3] if hasattr(value, "__len__") else (value,) * 3, dtype=np.float64)

    def number(self, port: Port) -> float:
        """Return the value of a number socket; of a colour, the mean of its channels."""
        return float(self.color(port).mean())

    def is_linked(self, port: Port) -> bool:
        """Tell whether a node computes the value."""
        return source(port).socket.is_output

    def name(self, node: bpy.types.Node, text: str, advice: str = "") -> None:
        """Add a message about a node of the owner."""
        self.messages.add(self.owner, f'node "{node.label or node.name}" {text}', advice)

    def _value(self, port: Port) -> object:
        origin = source(port)
        if not origin.socket.is_output or origin.node.bl_idname in {"ShaderNodeRGB", "ShaderNodeValue"}:
            return getattr(origin.socket, "default_value", 0.0)
        self.name(
            port.node,
            f'has "{port.socket.name}" computed by "{origin.node.label or origin.node.name}", which is not evaluated; '
            "the socket's own value is used.",
            "Unlink it and set the value, or bake the texture.",
        )
        return getattr(port.socket, "default_value", 0.0)
