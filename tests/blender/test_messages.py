# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages are shown with all they say, lead to their objects, and go into the diagnostics."""

from __future__ import annotations

import bpy
import pytest

from tests.blender.layouts import drawn
from tests.blender.scenes import link, material, render


@pytest.fixture
def noted(corner):
    """The corner with a node that is not supported in the wall's material, twice, and an empty image on the floor."""
    tree = bpy.data.objects["Wall"].active_material.node_tree
    shader = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfDiffuse")
    noise = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs["Color"], shader.inputs["Color"])
    tree = bpy.data.objects["Floor"].active_material.node_tree
    shader = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfDiffuse")
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = bpy.data.images.new("Lost", 4, 4)
    image.image.source, image.image.filepath = "FILE", "//lost.png"
    tree.links.new(image.outputs["Color"], shader.inputs["Color"])
    render(corner)
    return corner


def said(extension, scene):
    """Return the messages of the scene's last render."""
    return extension.engine.last_render.recall(scene.session_uid, scene.view_layers[0].name).messages


def test_a_message_has_object_node_advice_and_count(noted, extension):
    (message,) = [message for message in said(extension, noted) if message.node]
    assert (message.object, message.node) == ("Wall", '"Noise Texture"') and message.text and message.advice
    shown = drawn(extension, "PHOTON_MAPS_PT_messages", module="messages_panel")
    text = " ".join(shown.texts)
    assert 'Node "Noise Texture"' in text and message.text.split()[0] in text
    named = [button for button in shown.operators if button.operator == "photon_maps.select_named"]
    assert {button.name for button in named} >= {"Wall", "Lost"}


@pytest.mark.parametrize(("name", "expected"), [("Wall", {"Wall"}), ("Lost", {"Floor"}), ("Paint", {"Wall", "Floor"})])
def test_a_message_leads_to_its_objects(noted, name, expected):
    """By the object's own name, by an image's in a material, by a material's."""
    paint = material("Paint")
    if name == "Paint":
        for thing in ("Wall", "Floor"):
            bpy.data.objects[thing].data.materials.append(paint)
    bpy.data.objects["Lamp"].select_set(True)
    assert bpy.ops.photon_maps.select_named(name=name) == {"FINISHED"}
    assert {thing.name for thing in noted.objects if thing.select_get()} == expected
    assert bpy.context.view_layer.objects.active.name in expected


def test_what_cannot_be_selected_is_said_and_leaves_the_selection(corner):
    hidden = link(corner, "Hidden", None)
    hidden.hide_set(True)
    bpy.data.objects["Lamp"].select_set(True)
    for name in ("Nothing of that name", corner.name, "Hidden"):
        assert bpy.ops.photon_maps.select_named(name=name) == {"CANCELLED"}
    assert [thing.name for thing in corner.objects if thing.select_get()] == ["Lamp"]


def test_diagnostics_say_what_a_report_needs(noted, extension):
    text = extension.engine.diagnostics.diagnostics(noted, noted.view_layers[0])
    for words in (
        *(f"Photon Maps {extension.engine.summary.VERSION}", f"Blender {bpy.app.version_string}", "32 x 32 pixels"),
        *("stop: PASSES", "estimate: ADAPTIVE", "photons_emitted: ", "Global map: ", 'Wall: node "Noise Texture"'),
    ):
        assert words in text
    assert "/" not in text.split("Messages")[0]


def test_diagnostics_before_the_first_render(scene, extension):
    text = extension.engine.diagnostics.diagnostics(scene, scene.view_layers[0])
    assert text.count("None.") == 3


def test_the_last_renders_figures_are_shown(noted, extension):
    texts = drawn(extension, "PHOTON_MAPS_PT_statistics", module="messages_panel").texts
    assert any("1 passes in 00:0" in line for line in texts) and any("MB" in line for line in texts)


def test_a_render_is_counted_so_that_panels_are_drawn_again(corner, extension):
    before = extension.engine.last_render.count()
    render(corner)
    assert extension.engine.last_render.count() == before + 1


def test_many_messages_are_cut_short(corner, extension):
    last_render, messages = extension.engine.last_render, extension.engine.messages
    many = tuple(messages.Message(f"Object {number}", "is odd.") for number in range(1000))
    last_render.remember(corner.session_uid, corner.view_layers[0].name, last_render.LastRender(many))
    shown = drawn(extension, "PHOTON_MAPS_PT_messages", module="messages_panel")
    assert len(shown.operators) == extension.ui.messages_panel.MOST_SHOWN + 1
    assert any("970 more" in line for line in shown.texts)
