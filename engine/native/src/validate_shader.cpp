// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of images, textures, tables and shaders.
#include <cmath>
#include <cstring>
#include <set>

#include "convert.h"
#include "shader_ops.h"
#include "validate.h"

namespace photon_maps {

namespace {

constexpr uint32_t max_image_side = 65536;
constexpr float max_constant = 1e15f;

void require_numbers(std::span<const float> values, float limit, const std::string &name) {
    for (size_t i = 0; i < values.size(); ++i)
        require(std::abs(values[i]) <= limit, name + ": number " + std::to_string(i) + " is " +
                                                  std::to_string(values[i]) + ", not finite or too large");
}

/// Image data may not be aligned.
void require_finite_pixels(const pm_image &image) {
    const size_t count = size_t{image.width} * image.height * image.channels;
    const auto *bytes = static_cast<const std::byte *>(image.pixels);
    for (size_t i = 0; i < count; ++i) {
        bool is_sound = true;
        if (image.type == PM_PIXEL_FLOAT32) {
            float value;
            std::memcpy(&value, bytes + sizeof value * i, sizeof value);
            is_sound = std::isfinite(value);
        } else {
            uint16_t value;
            std::memcpy(&value, bytes + sizeof value * i, sizeof value);
            is_sound = (value & 0x7c00u) != 0x7c00u;
        }
        require(is_sound, "image: number " + std::to_string(i) + " of its pixels is not finite");
    }
}

void validate_instruction(const pm_instruction &instruction, const pm_material &material, size_t texture_count,
                          size_t table_count, uint64_t written, const std::string &name) {
    const auto shape = shape_of(instruction.op, instruction.option);
    require(shape.has_value(), name + ": unknown operation " + std::to_string(instruction.op));
    const bool is_table = instruction.op == PM_OP_TABLE || instruction.op == PM_OP_CURVES;
    const std::string option = name + ": option " + std::to_string(instruction.option);
    if (instruction.op == PM_OP_TEXTURE) require(instruction.option < texture_count, option + " is no texture");
    if (is_table) require(instruction.option < table_count, option + " is no table");
    if (instruction.op == PM_OP_NORMAL_MAP)
        require((instruction.option & 0xff) < PM_NORMAL_SPACE_COUNT, option + " names an unknown space");
    require(shape->option_count == 0 || instruction.option < shape->option_count, option + " is unknown");
    require(instruction.shift <= (shape->can_shift ? 2u : 0u),
            name + ": shift is " + std::to_string(instruction.shift));
    require(instruction.argument_count == shape->argument_count,
            name + ": has " + std::to_string(instruction.argument_count) + " arguments, needs " +
                std::to_string(shape->argument_count));
    require(uint64_t{instruction.first_argument} + instruction.argument_count <= material.argument_count,
            name + ": its arguments reach beyond the " + std::to_string(material.argument_count) + " there are");
    for (uint32_t i = 0; i < instruction.argument_count; ++i) {
        const uint32_t argument = material.arguments[instruction.first_argument + i];
        require(argument < written, name + ": argument " + std::to_string(i) + " is register " +
                                        std::to_string(argument) + ", which is not written before");
    }
    require(shape->output_count == 0 || instruction.output == written,
            name + ": output is register " + std::to_string(instruction.output) + ", the next free one is " +
                std::to_string(written));
}

}  // namespace

void validate(const pm_image &image) {
    require_struct_size(image.struct_size, sizeof(pm_image), "pm_image");
    require(image.type <= PM_PIXEL_FLOAT32, "image: unknown type " + std::to_string(image.type));
    require(image.channels == 1 || image.channels == 3 || image.channels == 4,
            "image: channels are 1, 3 or 4, not " + std::to_string(image.channels));
    const auto is_side = [](uint32_t side) { return side >= 1 && side <= max_image_side; };
    require(is_side(image.width) && is_side(image.height), "image: its size is " + std::to_string(image.width) + " x " +
                                                               std::to_string(image.height) +
                                                               ", but sides are 1 to 65536 pixels");
    require(image.pixels != nullptr, "image: pixels is null");
    require(image.type != PM_PIXEL_UINT8 || image.decode != nullptr, "image: decode is null, which bytes need");
    if (image.decode) require_numbers({image.decode, size_t{3} * 256}, max_constant, "image: decode");
    if (image.type != PM_PIXEL_UINT8) require_finite_pixels(image);
}

void validate(const pm_texture &texture, size_t image_count) {
    require_struct_size(texture.struct_size, sizeof(pm_texture), "pm_texture");
    require(texture.interpolation <= PM_INTERPOLATION_CUBIC,
            "texture: unknown interpolation " + std::to_string(texture.interpolation));
    require(texture.extension <= PM_EXTENSION_MIRROR,
            "texture: unknown extension " + std::to_string(texture.extension));
    require(texture.projection <= PM_PROJECTION_MIRROR_BALL,
            "texture: unknown projection " + std::to_string(texture.projection));
    require(texture.alpha <= PM_ALPHA_IGNORED, "texture: unknown alpha " + std::to_string(texture.alpha));
    require(texture.blend >= 0 && texture.blend <= 1, "texture: blend is " + std::to_string(texture.blend));
    require(texture.tile_count >= 1 && texture.tile_count <= 1000, "texture: it has 1 image, or 1 to 1000 tiles");
    require(texture.images != nullptr, "texture: images is null");
    require(texture.tiles || texture.tile_count == 1, "texture: several images need tiles");
    std::set<uint32_t> numbers;
    for (size_t i = 0; i < texture.tile_count; ++i) {
        require(texture.images[i] < image_count, "texture: image " + std::to_string(texture.images[i]) +
                                                     " does not exist, there are " + std::to_string(image_count));
        if (!texture.tiles) continue;
        const uint32_t number = texture.tiles[i];
        require(number >= 1001 && number <= 2000,
                "texture: tile " + std::to_string(number) + " is not between 1001 and 2000");
        require(numbers.insert(number).second, "texture: tile " + std::to_string(number) + " is there twice");
    }
}

void validate(const pm_table &table) {
    require_struct_size(table.struct_size, sizeof(pm_table), "pm_table");
    require(table.entry_count >= 1, "table: it has no entries");
    require(table.entry_count <= 1u << 20, "table: it has more than 2^20 entries");
    require(table.entries != nullptr, "table: entries is null");
    require_numbers({table.entries, 4 * table.entry_count}, max_constant, "table");
}

void validate(const pm_material &material, size_t index, size_t texture_count, size_t table_count) {
    const std::string name = "material " + std::to_string(index);
    require_struct_size(material.struct_size, sizeof(pm_material), "pm_material");
    validate_count(material.constant_count, "constants of " + name);
    validate_count(material.instruction_count, "instructions of " + name);
    validate_count(material.argument_count, "arguments of " + name);
    require(material.constants || material.constant_count == 0, name + ": constants is null");
    require(material.instructions || material.instruction_count == 0, name + ": instructions is null");
    require(material.arguments || material.argument_count == 0, name + ": arguments is null");
    require_numbers({material.constants, 3 * material.constant_count}, max_constant, name + ": constants");
    uint64_t written = material.constant_count;
    for (size_t i = 0; i < material.instruction_count; ++i) {
        const pm_instruction &instruction = material.instructions[i];
        validate_instruction(instruction, material, texture_count, table_count, written,
                             name + ": instruction " + std::to_string(i));
        written += shape_of(instruction.op, instruction.option)->output_count;
    }
    require(written <= max_registers, name + ": its shader needs " + std::to_string(written) +
                                          " registers, but may have " + std::to_string(max_registers) +
                                          ": it has too many nodes");
}

}  // namespace photon_maps
