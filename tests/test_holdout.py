# SPDX-License-Identifier: GPL-3.0-or-later
"""The program of a holdout object: a hole for the camera, the material itself for other rays."""

from __future__ import annotations

import numpy as np
import pytest
from photon_maps_native.shader import Input, Math, Op, PrincipledArgument, Shader

from engine.export.holdout import held_out


def closures(material, is_camera_ray):
    """Run the arithmetic of a program and return its closures and the values of their arguments.

    As the helper demands: every instruction writes the next register, and reads only what is written.
    """
    registers = [row.astype(np.float64) for row in material.constants]
    found = []
    for op, option, _, output, first, count in material.instructions.tolist():
        arguments = [registers[index] for index in material.arguments[first : first + count]]
        if op >= Op.DIFFUSE:
            found.append((Op(op), arguments))
            continue
        assert output == len(registers)
        match op, option:
            case Op.INPUT, Input.IS_CAMERA_RAY:
                registers.append(np.full(3, float(is_camera_ray)))
            case Op.INPUT, _:
                registers.append(np.full(3, 7.0))
            case Op.MATH, Math.SUBTRACT:
                registers.append(arguments[0] - arguments[1])
            case Op.MATH, Math.MULTIPLY:
                registers.append(arguments[0] * arguments[1])
            case Op.LAYER_WEIGHT, _:
                registers += [np.full(3, 0.25), np.full(3, 0.5)]
            case _:
                pytest.fail(f"{Op(op)!r} is not known here")
    return found


def shining_glass():
    """Diffuse, emission and a pane that one sees through by the second output of an operation."""
    shader = Shader()
    normal = shader.input(Input.NORMAL)
    fresnel = shader.add(Op.LAYER_WEIGHT, shader.constant(0.5), normal, outputs=2)
    shader.close(Op.DIFFUSE, shader.constant((0.1, 0.2, 0.3)), shader.constant(0.0), normal)
    shader.close(Op.EMISSION, shader.constant((3.0, 2.0, 1.0)))
    shader.close(Op.TRANSPARENT, fresnel + 1)
    shader.close(Op.HOLDOUT, fresnel)
    return shader.material(index=5)


def principled(alpha):
    shader = Shader()
    values = [shader.constant(0.5)] * 19
    values[PrincipledArgument.ALPHA - 1] = shader.constant(alpha)
    shader.close(Op.PRINCIPLED, shader.constant(0.75), *values, option=1)
    return shader.material()


def test_other_rays_meet_the_material_itself():
    material = held_out(shining_glass())
    assert material.index == 5
    scattering = [(op, values) for op, values in closures(material, False) if op != Op.TRANSPARENT or values[0].any()]
    expected = closures(shining_glass(), False)
    assert [op for op, _ in scattering] == [*(op for op, _ in expected), Op.HOLDOUT]
    for (_, values), (_, wanted) in zip(scattering, expected, strict=False):
        np.testing.assert_allclose(values, wanted)
    assert not scattering[-1][1][0].any()


def test_the_camera_sees_a_hole_and_what_is_transparent():
    found = closures(held_out(shining_glass()), True)
    weight = {op: sum(values[0] for kind, values in found if kind == op) for op, _ in found}
    np.testing.assert_allclose(weight[Op.TRANSPARENT], 0.5)
    np.testing.assert_allclose(weight[Op.HOLDOUT], 0.5)
    assert not weight[Op.DIFFUSE].any() and not weight[Op.EMISSION].any()


@pytest.mark.parametrize("alpha", [0.0, 0.25, 1.0])
def test_the_transparency_of_a_principled_bsdf_stays(alpha):
    found = dict(closures(held_out(principled(alpha)), True))
    np.testing.assert_allclose(found[Op.TRANSPARENT][0], 0.75 * (1.0 - alpha))
    np.testing.assert_allclose(found[Op.HOLDOUT][0], 1.0 - 0.75 * (1.0 - alpha))
    assert not found[Op.PRINCIPLED][0].any()
    others = dict(closures(held_out(principled(alpha)), False))
    np.testing.assert_allclose(others[Op.PRINCIPLED], closures(principled(alpha), False)[0][1])
    assert not others[Op.TRANSPARENT][0].any() and not others[Op.HOLDOUT][0].any()
