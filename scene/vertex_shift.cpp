#include "scene/vertex_shift.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <vector>

namespace nextview {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// The next line, without its end, taken from the front.
std::string_view take_line(std::string_view& bytes) {
  const std::size_t end = bytes.find('\n');
  const std::string_view line = bytes.substr(0, end);
  bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
  return line;
}

/// The next word, taken from the front; empty at the end.
std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

std::optional<double> number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (word.empty() || error != std::errc() || end != word.data() + word.size()) return {};
  return number;
}

/// The shortest that gives the same double when it is read.
void append_number(std::string& text, double number) {
  std::array<char, 32> digits;
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
}

/// What the header of a PLY says of its vertices.
struct PlyHeader {
  bool is_text = false;
  std::size_t vertices = 0;
  std::size_t properties = 0;              ///< of a vertex
  std::size_t stride = 0;                  ///< bytes a vertex, in binary
  std::array<std::size_t, 3> column = {};  ///< of x, y, z among the properties
  std::array<std::size_t, 3> offset = {};  ///< of x, y, z in a vertex, bytes
  int coordinates = 0;                     ///< of x, y, z, how many there are
  bool has_floats = false;                 ///< among x, y, z
};

std::size_t bytes_of_type(std::string_view type) {
  static const std::map<std::string_view, std::size_t> kBytes = {
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = kBytes.find(type);
  return found == kBytes.end() ? 0 : found->second;
}

/// Adds a property to a vertex; false for a list and what else is unknown.
bool add_property(PlyHeader& header, std::string_view type, std::string_view name) {
  const std::size_t bytes = bytes_of_type(type);
  if (bytes == 0) return false;
  if (name == "x" || name == "y" || name == "z") {
    const auto axis = static_cast<std::size_t>(name[0] - 'x');
    header.column[axis] = header.properties;
    header.offset[axis] = header.stride;
    header.has_floats = header.has_floats || bytes != sizeof(double);
    ++header.coordinates;
  }
  ++header.properties;
  header.stride += bytes;
  return true;
}

/// Takes the header from the front of the file.
std::optional<PlyHeader> take_header(std::string_view& bytes) {
  PlyHeader header;
  int elements = 0;
  while (!bytes.empty()) {
    std::string_view line = take_line(bytes);
    const std::string_view keyword = take_word(line);
    const std::string_view first = take_word(line);
    const std::string_view second = take_word(line);
    if (keyword == "format") {
      header.is_text = first == "ascii";
      if (!header.is_text && first != "binary_little_endian") return {};
    } else if (keyword == "element") {
      ++elements;
      if ((first == "vertex") != (elements == 1)) return {};
      if (elements > 1) continue;
      const auto [end, error] =
          std::from_chars(second.data(), second.data() + second.size(), header.vertices);
      if (error != std::errc()) return {};
    } else if (keyword == "property" && elements == 1) {
      if (!add_property(header, first, second)) return {};
    } else if (keyword == "end_header") {
      return header.coordinates == 3 ? std::optional(header) : std::nullopt;
    }
  }
  return {};
}

bool shift_text(const PlyHeader& header, const Eigen::Vector3d& shift, std::string_view rest,
                std::string& shifted) {
  for (std::size_t vertex = 0; vertex < header.vertices; ++vertex) {
    if (rest.empty()) return false;
    std::string_view line = take_line(rest);
    for (std::size_t column = 0; column < header.properties; ++column) {
      const std::string_view word = take_word(line);
      if (word.empty()) return false;
      std::size_t axis = 0;
      while (axis < 3 && header.column[axis] != column) ++axis;
      if (axis == 3) {
        shifted += word;
      } else {
        const std::optional<double> number = number_in(word);
        if (!number) return false;
        append_number(shifted, *number - shift[static_cast<Eigen::Index>(axis)]);
      }
      shifted += column + 1 < header.properties ? ' ' : '\n';
    }
  }
  shifted += rest;
  return true;
}

bool shift_doubles(const PlyHeader& header, const Eigen::Vector3d& shift, std::string_view rest,
                   std::string& shifted) {
  if (header.has_floats || rest.size() / header.stride < header.vertices) return false;
  const std::size_t before = shifted.size();
  shifted += rest;
  char* vertex = shifted.data() + before;
  for (std::size_t i = 0; i < header.vertices; ++i, vertex += header.stride) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double coordinate = 0.0;
      std::memcpy(&coordinate, vertex + header.offset[axis], sizeof coordinate);
      coordinate -= shift[static_cast<Eigen::Index>(axis)];
      std::memcpy(vertex + header.offset[axis], &coordinate, sizeof coordinate);
    }
  }
  return true;
}

}  // namespace

std::optional<std::string> shifted_obj(std::string_view bytes, const Eigen::Vector3d& shift) {
  std::string shifted;
  shifted.reserve(bytes.size());
  while (!bytes.empty()) {
    const std::string_view line = take_line(bytes);
    std::string_view rest = line;
    if (take_word(rest) == "v") {
      shifted += 'v';
      for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> number = number_in(take_word(rest));
        if (!number) return {};
        shifted += ' ';
        append_number(shifted, *number - shift[axis]);
      }
      shifted += rest;
    } else {
      shifted += line;
    }
    shifted += '\n';
  }
  return shifted;
}

std::optional<std::string> shifted_ply(std::string_view bytes, const Eigen::Vector3d& shift) {
  std::string_view rest = bytes;
  const std::optional<PlyHeader> header = take_header(rest);
  if (!header) return {};
  std::string shifted;
  shifted.reserve(bytes.size());
  shifted = bytes.substr(0, bytes.size() - rest.size());
  const bool done = header->is_text ? shift_text(*header, shift, rest, shifted)
                                    : shift_doubles(*header, shift, rest, shifted);
  return done ? std::optional(std::move(shifted)) : std::nullopt;
}

}  // namespace nextview
