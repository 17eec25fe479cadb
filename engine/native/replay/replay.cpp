// SPDX-License-Identifier: GPL-3.0-or-later
// Repeats recorded calls of the C interface, so that the library of any platform renders without Python or Blender.
//   replay LIBRARY EMBREE RECORDING PICTURES [remove FOLDER]
// The first two are full paths. What the calls read of pictures goes to PICTURES, as float32 one after the other. With
// `remove` FOLDER is removed after LIBRARY was let go, as when the extension is removed.
// tests/platforms/recording.py writes recordings and says how they are laid out; it is for little-endian machines.
#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "dynamic_library.h"

namespace {

/// How a recording says what an argument is.
enum class Argument : uint32_t { number, block, handle, new_handle, scratch, pixels, embree };

/// A file, read from its beginning to its end.
class Reader {
  public:
    explicit Reader(const std::string &path) {
        std::ifstream file(path, std::ios::binary);
        if (!file) throw std::runtime_error("cannot read " + path);
        bytes_.assign(std::istreambuf_iterator<char>(file), {});
    }

    template <typename T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }

    std::span<const char> take(size_t count) {
        if (count > bytes_.size() - at_) throw std::runtime_error("the recording ends too early");
        at_ += count;
        return std::span(bytes_).subspan(at_ - count, count);
    }

  private:
    std::vector<char> bytes_;
    size_t at_ = 0;
};

using Block = std::vector<uint64_t>;  // of bytes, aligned as any structure asks

/// Reads the blocks of memory that arguments point to, and puts in the pointers among them.
std::vector<Block> read_blocks(Reader &reader) {
    std::vector<Block> blocks(reader.number<uint32_t>());
    for (Block &block : blocks) {
        const auto size = static_cast<size_t>(reader.number<uint64_t>());
        block.resize(size / sizeof(uint64_t) + 1);
        if (size > 0) std::memcpy(block.data(), reader.take(size).data(), size);
        for (auto pointers = reader.number<uint32_t>(); pointers > 0; --pointers) {
            const auto offset = static_cast<size_t>(reader.number<uint64_t>());
            // A block comes after those that it points to.
            const void *target = blocks.at(reader.number<uint32_t>()).data();
            if (offset + sizeof target > size) throw std::runtime_error("a pointer lies outside its block");
            std::memcpy(reinterpret_cast<char *>(block.data()) + offset, &target, sizeof target);
        }
    }
    return blocks;
}

/// All arguments are integers or pointers, which every 64-bit platform passes alike.
using Function = uint32_t(uint64_t, uint64_t, uint64_t, uint64_t);
using LastError = const char *();

uint64_t address(const void *pointer) { return reinterpret_cast<uintptr_t>(pointer); }

void replay(const std::string &library_path, const std::string &embree, Reader reader, std::ofstream pictures) {
    const photon_maps::DynamicLibrary library(library_path);
    LastError *last_error = nullptr;
    library.resolve("pm_last_error", last_error);
    std::array<uint64_t, 8> handles{};
    std::array<uint64_t, 64> scratch{};
    std::vector<Block> blocks = read_blocks(reader);

    for (auto calls = reader.number<uint32_t>(); calls > 0; --calls) {
        const auto name_bytes = reader.take(reader.number<uint32_t>());
        const std::string name(name_bytes.begin(), name_bytes.end());
        Function *function = nullptr;
        library.resolve(name.c_str(), function);

        std::array<uint64_t, 4> arguments{};
        std::vector<float> pixels;
        for (uint32_t i = 0, count = reader.number<uint32_t>(); i < count; ++i) {
            const auto kind = static_cast<Argument>(reader.number<uint32_t>());
            const auto value = reader.number<uint64_t>();
            const auto index = static_cast<size_t>(value);
            uint64_t &argument = arguments.at(i);
            if (kind == Argument::number) argument = value;
            if (kind == Argument::block) argument = address(blocks.at(index).data());
            if (kind == Argument::handle) argument = handles.at(index);
            if (kind == Argument::new_handle) argument = address(&handles.at(index));
            if (kind == Argument::scratch) argument = address(scratch.data());
            if (kind == Argument::embree) argument = address(embree.c_str());
            if (kind == Argument::pixels) {
                pixels.resize(index);
                argument = address(pixels.data());
            }
        }
        // What returns nothing is recorded as what releases a handle.
        const uint32_t status = function(arguments[0], arguments[1], arguments[2], arguments[3]);
        if (status != 0 && !name.ends_with("_release")) throw std::runtime_error(name + ": " + last_error());
        const auto bytes = static_cast<std::streamsize>(pixels.size() * sizeof(float));
        if (bytes > 0) pictures.write(reinterpret_cast<const char *>(pixels.data()), bytes);
    }
    if (!pictures.flush()) throw std::runtime_error("the pictures cannot be written");
}

}  // namespace

int main(int count, char **values) {
    const std::vector<std::string> arguments(values, values + count);
    const bool remove = arguments.size() == 7 && arguments[5] == "remove";
    if (arguments.size() != 5 && !remove) {
        std::cerr << "usage: replay LIBRARY EMBREE RECORDING PICTURES [remove FOLDER]\n";
        return 2;
    }
    try {
        // In a thread that ends when the libraries have been let go, as a render's does in Blender.
        std::exception_ptr failure;
        std::thread([&] {
            try {
                replay(arguments[1], arguments[2], Reader(arguments[3]), std::ofstream(arguments[4], std::ios::binary));
            } catch (...) {
                failure = std::current_exception();
            }
        }).join();
        if (failure) std::rethrow_exception(failure);
        if (remove) std::filesystem::remove_all(arguments[6]);  // throws where a file of it is in use
    } catch (const std::exception &error) {
        std::cerr << "replay: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
