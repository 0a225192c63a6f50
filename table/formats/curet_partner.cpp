#include "table/formats/curet_partner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "table/file_error.h"
#include "table/formats/number_text.h"
#include "table/formats/text_lines.h"

namespace gonio::table {

namespace {

constexpr std::size_t direction_fields = 5;
constexpr std::size_t fewest_directions = 50;

/// The next line that is neither blank nor a comment; false if there is none.
bool next_row(LineReader& lines, std::string_view& line) {
  while (lines.next(line)) {
    if (!line.empty() && !line.starts_with('#')) return true;
  }
  return false;
}

/// How many numbers a line holds and which is the first; none if there is anything else.
struct RowShape {
  std::size_t count = 0;
  double first = 0;
};

RowShape shape_of(std::string_view line) {
  RowShape shape;
  const char* const end = line.data() + line.size();
  for (const char* at = line.data(); at != end; at = skip_blanks(at, end)) {
    double value = 0;
    if (read_number(at, end, value) != NumberText::number) return {};
    if (at != end && !is_blank(*at)) return {};
    if (shape.count++ == 0) shape.first = value;
  }
  return shape;
}

/// The beginning of the content without the line that its end cuts.
std::string_view first_lines(std::string_view content) {
  constexpr std::size_t enough = std::size_t{1} << 15;
  if (content.size() <= enough) return content;
  content = content.substr(0, enough);
  const std::size_t end = content.rfind('\n');
  return end == std::string_view::npos ? std::string_view() : content.substr(0, end);
}

bool is_whole(double number) { return number >= 1 && number == std::floor(number); }

std::size_t count_rows(std::string_view content) {
  LineReader lines(content);
  std::size_t count = 0;
  for (std::string_view line; next_row(lines, line);) ++count;
  return count;
}

/// How many directions a file of this kind is for.
std::size_t count_directions(std::string_view content, CuretKind kind) {
  content = without_byte_order_mark(content);
  if (kind == CuretKind::directions) return count_rows(content);
  LineReader lines(content);
  std::string_view line;
  return next_row(lines, line) ? shape_of(line).count - 1 : 0;
}

using Path = std::filesystem::path;

/// The ending .txt or .dat, in letters of either case.
bool has_usual_ending(const Path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".txt" || ending == ".dat";
}

/// The files that may be the partner, in the order in which they are tried.
std::vector<Path> candidates(const Path& folder, const std::string& published_name) {
  constexpr std::size_t most_others = 100;
  std::vector<Path> others;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (has_usual_ending(entry->path())) others.push_back(entry->path());
  }
  std::sort(others.begin(), others.end());
  others.resize(std::min(others.size(), most_others));
  others.insert(others.begin(), folder / published_name);
  return others;
}

/// The file if it can be read, is no pipe and has content; else null.
std::unique_ptr<const InputFile> opened(const Path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return nullptr;
  try {
    return std::make_unique<const InputFile>(path.string());
  } catch (const FileError&) {
    return nullptr;  // what cannot be read is not the partner
  }
}

}  // namespace

CuretKind curet_kind(std::string_view content) {
  LineReader lines(first_lines(without_byte_order_mark(content)));
  std::size_t rows = 0;
  std::size_t fields = 0;
  bool is_numbered = true;
  for (std::string_view line; next_row(lines, line);) {
    const RowShape shape = shape_of(line);
    if (rows == 0) fields = shape.count;
    if (shape.count == 0 || shape.count != fields || !is_whole(shape.first)) {
      return CuretKind::none;
    }
    ++rows;
    is_numbered = is_numbered && shape.first == static_cast<double>(rows);
  }
  if (fields == direction_fields && is_numbered && rows >= fewest_directions) {
    return CuretKind::directions;
  }
  return fields > fewest_directions ? CuretKind::measurements : CuretKind::none;
}

CuretPartner::CuretPartner(std::string_view content, const std::string& path) {
  const CuretKind kind = curet_kind(content);
  const bool has_directions = kind == CuretKind::directions;
  const CuretKind wanted = has_directions ? CuretKind::measurements : CuretKind::directions;
  const std::size_t directions = count_directions(content, kind);
  const std::string published_name = has_directions ? "abrdf.dat" : "table.txt";
  const Path folder = Path(path).has_parent_path() ? Path(path).parent_path() : Path(".");
  for (const Path& candidate : candidates(folder, published_name)) {
    std::unique_ptr<const InputFile> file = opened(candidate);
    if (file == nullptr || curet_kind(file->bytes()) != wanted) continue;
    if (count_directions(file->bytes(), wanted) != directions) continue;
    path_ = candidate.string();
    file_ = std::move(file);
    return;
  }
  throw FileError(fmt::format(
      "{}: these are CUReT's {} {} without {}: expected in the same folder the file {}, or another "
      ".txt or .dat file, with {}: put it there",
      path, directions, has_directions ? "directions" : "measurements per material",
      has_directions ? "the measurements" : "the directions", published_name,
      has_directions
          ? fmt::format("rows of a material's number and {} measurements", directions)
          : fmt::format("{} rows of index, theta_v, phi_v, theta_i, phi_i", directions)));
}

}  // namespace gonio::table
