// SPDX-License-Identifier: GPL-3.0-or-later
#include "fold.h"

#include <memory>

#include "evaluate.h"
#include "scene.h"
#include "shader_math.h"

namespace photon_maps {

namespace {

/// Instructions whose registers are yet to be numbered anew.
struct Draft {
    std::vector<std::optional<Vec3>> known;  ///< by register: its value, if it needs no instruction
    std::vector<pm_instruction> instructions;
    std::vector<uint32_t> arguments;

    std::span<const uint32_t> arguments_of(const pm_instruction &instruction) const {
        return std::span(arguments).subspan(instruction.first_argument, instruction.argument_count);
    }
    void add(pm_instruction instruction, std::span<const uint32_t> registers) {
        instruction.first_argument = static_cast<uint32_t>(arguments.size());
        arguments.insert(arguments.end(), registers.begin(), registers.end());
        instructions.push_back(instruction);
    }
};

uint32_t output_count(const pm_instruction &instruction) {
    return shape_of(instruction.op, instruction.option)->output_count;
}

size_t register_count(const Program &program) {
    size_t count = program.constants.size();
    for (const pm_instruction &instruction : program.instructions) count += output_count(instruction);
    return count;
}

/// Marks the registers that closures depend on.
std::vector<bool> living_registers(const Draft &draft) {
    std::vector<bool> lives(draft.known.size());
    for (auto instruction = draft.instructions.rbegin(); instruction != draft.instructions.rend(); ++instruction) {
        bool is_needed = is_closure(instruction->op);
        for (uint32_t i = 0; i < output_count(*instruction); ++i) is_needed |= lives[instruction->output + i];
        if (!is_needed) continue;
        for (const uint32_t argument : draft.arguments_of(*instruction)) lives[argument] = true;
        // Both outputs of two are numbered, even if one is not read.
        for (uint32_t i = 0; i < output_count(*instruction); ++i) lives[instruction->output + i] = true;
    }
    return lives;
}

/// Numbers the registers anew, constants first, less what is not needed.
Program numbered(const Draft &draft) {
    const std::vector<bool> lives = living_registers(draft);
    Program program;
    std::vector<uint32_t> number(draft.known.size());
    for (size_t i = 0; i < draft.known.size(); ++i) {
        if (!lives[i] || !draft.known[i]) continue;
        number[i] = static_cast<uint32_t>(program.constants.size());
        program.constants.push_back(*draft.known[i]);
    }
    auto next = static_cast<uint32_t>(program.constants.size());
    for (pm_instruction instruction : draft.instructions) {
        if (!is_closure(instruction.op) && !lives[instruction.output]) continue;
        const std::span<const uint32_t> arguments = draft.arguments_of(instruction);
        instruction.first_argument = static_cast<uint32_t>(program.arguments.size());
        for (const uint32_t argument : arguments) program.arguments.push_back(number[argument]);
        for (uint32_t i = 0; i < output_count(instruction); ++i) number[instruction.output + i] = next + i;
        instruction.output = next;
        next += output_count(instruction);
        program.instructions.push_back(instruction);
    }
    program.register_count = next;
    return program;
}

/// Finds a register that has the instruction's value anyway: products with 1, sums with 0, mixes of one.
std::optional<uint32_t> same_value(const Draft &draft, const pm_instruction &instruction,
                                   std::span<const uint32_t> arguments) {
    const auto is = [&](size_t i, float value) {
        return draft.known[arguments[i]] && *draft.known[arguments[i]] == splat(value);
    };
    if (instruction.op == PM_OP_MATH && instruction.option == PM_MATH_MULTIPLY) {
        if (is(0, 1) || is(1, 0)) return arguments[1];
        if (is(1, 1) || is(0, 0)) return arguments[0];
    }
    if (instruction.op == PM_OP_MATH && instruction.option == PM_MATH_ADD) {
        if (is(0, 0)) return arguments[1];
        if (is(1, 0)) return arguments[0];
    }
    if (instruction.op == PM_OP_MIX || (instruction.op == PM_OP_BLEND && instruction.option == PM_BLEND_MIX)) {
        if (is(0, 0)) return arguments[1];
        if (is(0, 1)) return arguments[2];
    }
    return {};
}

}  // namespace

std::optional<Vec3> constant_argument(const Program &program, const pm_instruction &instruction, size_t i) {
    const uint32_t argument = program.arguments[instruction.first_argument + i];
    if (argument >= program.constants.size()) return {};
    return program.constants[argument];
}

Program folded(const Program &program, uint32_t material_index, const Scene &scene) {
    Draft draft{{program.constants.begin(), program.constants.end()}, {}, {}};
    draft.known.resize(register_count(program));
    const auto registers = std::make_unique<Registers>();
    for (size_t i = 0; i < program.constants.size(); ++i) registers->set(i, program.constants[i]);
    std::vector<uint32_t> same_as(draft.known.size());
    for (uint32_t i = 0; i < same_as.size(); ++i) same_as[i] = i;

    for (const pm_instruction &instruction : program.instructions) {
        std::vector<uint32_t> arguments;
        for (uint32_t i = 0; i < instruction.argument_count; ++i)
            arguments.push_back(same_as[program.arguments[instruction.first_argument + i]]);
        const bool knows_all = std::all_of(arguments.begin(), arguments.end(),
                                           [&](uint32_t argument) { return draft.known[argument].has_value(); });
        if (instruction.op == PM_OP_INPUT && instruction.option == PM_INPUT_MATERIAL_INDEX) {
            registers->set(instruction.output, splat(static_cast<float>(material_index)));
            draft.known[instruction.output] = (*registers)[instruction.output];
        } else if (knows_all && is_pure(scene, instruction)) {
            evaluate_pure(scene, instruction, {*registers, arguments}, *registers);
            for (uint32_t i = instruction.output; i < instruction.output + output_count(instruction); ++i)
                draft.known[i] = (*registers)[i];
        } else if (const auto same = same_value(draft, instruction, arguments)) {
            same_as[instruction.output] = *same;
        } else {
            draft.add(instruction, arguments);
        }
    }
    return numbered(draft);
}

Program with_closures(const Program &program, const std::function<bool(const pm_instruction &)> &wanted) {
    Draft draft{{program.constants.begin(), program.constants.end()}, {}, {}};
    draft.known.resize(register_count(program));
    for (const pm_instruction &instruction : program.instructions) {
        if (is_closure(instruction.op) && !wanted(instruction)) continue;
        draft.add(instruction,
                  std::span(program.arguments).subspan(instruction.first_argument, instruction.argument_count));
    }
    return numbered(draft);
}

}  // namespace photon_maps
