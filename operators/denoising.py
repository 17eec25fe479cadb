# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own Denoise node, set up in one click."""

from __future__ import annotations

import bpy

from .polling import is_engine

#: Outputs of a Render Layers node, and the inputs of a Denoise node that they lead to.
GUIDES = {"Denoising Albedo": "Albedo", "Denoising Normal": "Normal"}
IS_GROUP = bpy.app.version >= (5, 0, 0)  #: the compositor is a node group
STEP = 200.0  #: between two nodes in the editor


class PHOTON_MAPS_OT_set_up_denoising(bpy.types.Operator):
    bl_idname = "photon_maps.set_up_denoising"
    bl_label = "Set Up Denoise Node"
    bl_description = (
        "Switch on Denoising Data, and lead the picture through a Denoise node of the compositor. Takes seconds after "
        "the render; spots of single photons stay, for they are as wide as the radius"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not is_engine(cls, context):
            return False
        if not context.scene.is_editable:
            cls.poll_message_set("The scene is linked from another file")
        return context.scene.is_editable

    def execute(self, context: bpy.types.Context) -> set[str]:
        scene, layer = context.scene, context.view_layer
        layer.photon_maps.use_pass_denoising = True
        layer.update_render_passes()  # so that the node has their outputs
        scene.render.use_compositing = True
        lead_through_denoise(compositor(scene), scene, layer)
        return {"FINISHED"}


def compositor(scene: bpy.types.Scene) -> bpy.types.NodeTree:
    """Return a scene's compositor; a new one, with nothing but an output, if it has none."""
    if not IS_GROUP:
        scene.use_nodes = True
        return scene.node_tree
    if scene.compositing_node_group is None:
        tree = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        tree.nodes.new("NodeGroupOutput").location.x = 3 * STEP
        scene.compositing_node_group = tree
    return scene.compositing_node_group


def lead_through_denoise(tree: bpy.types.NodeTree, scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> None:
    """Put a Denoise node between a view layer's picture and all that it leads to; use the one that is there already."""
    source = _render_layers(tree, scene, layer)
    picture = source.outputs["Image"]
    links = [link for link in tree.links if link.from_socket == picture]
    denoise = next((link.to_node for link in links if link.to_node.bl_idname == "CompositorNodeDenoise"), None)
    if denoise is None:
        denoise = tree.nodes.new("CompositorNodeDenoise")
        denoise.location = source.location.x + 1.5 * STEP, source.location.y
        for target in [link.to_socket for link in links] or _free_outputs(tree):
            tree.links.new(denoise.outputs["Image"], target)
        tree.links.new(picture, denoise.inputs["Image"])
    for output, guide in GUIDES.items():
        if not denoise.inputs[guide].is_linked:
            tree.links.new(source.outputs[output], denoise.inputs[guide])


def _render_layers(tree: bpy.types.NodeTree, scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> bpy.types.Node:
    """Return the node that brings a view layer's passes."""
    for node in tree.nodes:
        if node.bl_idname == "CompositorNodeRLayers" and node.scene == scene and node.layer == layer.name:
            return node
    node = tree.nodes.new("CompositorNodeRLayers")
    node.scene, node.layer = scene, layer.name
    return node


def _free_outputs(tree: bpy.types.NodeTree) -> list[bpy.types.NodeSocket]:
    """Return the picture's way out of the compositor, if nothing leads there; there is one afterwards."""
    kind = "NodeGroupOutput" if IS_GROUP else "CompositorNodeComposite"
    output = next((node for node in tree.nodes if node.bl_idname == kind), None) or tree.nodes.new(kind)
    return [socket for socket in output.inputs[:1] if not socket.is_linked]


def register() -> None:
    bpy.utils.register_class(PHOTON_MAPS_OT_set_up_denoising)


def unregister() -> None:
    bpy.utils.unregister_class(PHOTON_MAPS_OT_set_up_denoising)
