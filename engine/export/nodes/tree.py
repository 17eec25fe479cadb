# SPDX-License-Identifier: GPL-3.0-or-later
"""Walking a shader node tree: where a socket's value comes from, through reroutes, groups and muted nodes."""

from __future__ import annotations

from dataclasses import dataclass

import bpy


@dataclass(frozen=True)
class Port:
    """A socket, and the group nodes it stands in, outermost first."""

    socket: bpy.types.NodeSocket
    groups: tuple[bpy.types.Node, ...] = ()

    @property
    def node(self) -> bpy.types.Node:
        return self.socket.node


def shader_tree(owner: bpy.types.Material | bpy.types.World) -> bpy.types.NodeTree | None:
    """Return the nodes that a material or world uses, if it does."""
    # From Blender 5.0 on they always do, and asking is deprecated.
    return owner.node_tree if bpy.app.version >= (5, 0, 0) or owner.use_nodes else None


def source(port: Port) -> tuple[Port, list[bpy.types.NodeSocket]]:
    """Follow the links upstream from an input.

    :return: the output that computes the value, or the unlinked input that holds it; and the sockets on the way
        there, the first one included and that one not, to whose types the value is converted.
    """
    passed = []
    while (upstream := _step(port)) is not None:
        # A muted node and a reroute convert to what they put out; what they take in has no say.
        if port.socket.is_output or not _is_bypassed(port.node):
            passed.append(port.socket)
        port = upstream
    return port, passed


def _is_bypassed(node: bpy.types.Node) -> bool:
    return node.mute or node.bl_idname == "NodeReroute"


def _step(port: Port) -> Port | None:
    socket, groups = port.socket, port.groups
    if not socket.is_output:
        # Blender marks links that would close a cycle invalid, so the walk ends.
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
        return Port(link.from_socket, groups) if link else None
    node = socket.node
    if node.bl_idname == "NodeReroute":
        return Port(node.inputs[0], groups)
    if node.mute:
        link = next((link for link in node.internal_links if link.to_socket == socket), None)
        return Port(link.from_socket, groups) if link else None
    if node.bl_idname == "ShaderNodeGroup" and node.node_tree:
        return _into_group(node, socket.identifier, groups)
    if node.bl_idname == "NodeGroupInput" and groups:
        outside = find_socket(groups[-1].inputs, socket.identifier)
        return Port(outside, groups[:-1]) if outside else None
    return None


def _into_group(node: bpy.types.Node, identifier: str, groups: tuple[bpy.types.Node, ...]) -> Port | None:
    outputs = [inner for inner in node.node_tree.nodes if inner.bl_idname == "NodeGroupOutput"]
    active = next((inner for inner in outputs if inner.is_active_output), None)
    socket = find_socket(active.inputs, identifier) if active else None
    return Port(socket, (*groups, node)) if socket else None


def find_socket(sockets: bpy.types.NodeInputs | bpy.types.NodeOutputs, identifier: str) -> bpy.types.NodeSocket | None:
    """Return a socket by its identifier, which is unique, unlike its name."""
    return next((socket for socket in sockets if socket.identifier == identifier), None)
