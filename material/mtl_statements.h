// The statements of a Wavefront material library (.mtl): lines, continued lines, comments, words,
// numbers.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::material {

/// A statement: its keyword in lower case, the rest of its line, and the line's number from 1.
struct MtlStatement {
  std::string keyword;
  std::string arguments;  // without blanks at either end; a comment is still in it
  int line = 0;
};

/// Walks over the statements of a text. Lines end in LF, CRLF or CR; a backslash at the end joins
/// the next one.
class MtlStatementReader {
 public:
  explicit MtlStatementReader(std::string_view text) : rest_(text) {}

  /// Sets `statement` to the next one, passing over empty lines and comments; false at the end.
  bool next(MtlStatement& statement);
  /// How many lines were read.
  std::size_t lines() const { return lines_; }

 private:
  std::string_view next_line();

  std::string_view rest_;
  std::size_t lines_ = 0;
};

/// The words of a statement's arguments before a comment, which `#` begins. They point into it.
std::vector<std::string_view> mtl_words(std::string_view arguments);

/// What is wrong with a statement: what() says what was found and expected, without file and line.
class MtlProblem : public std::runtime_error {
 public:
  MtlProblem(int line, const std::string& text) : std::runtime_error(text), line_(line) {}
  int line() const { return line_; }

 private:
  int line_;
};

/// The one number of a statement, finite; `keyword` is for messages. Throws MtlProblem.
double mtl_number(const MtlStatement& statement, std::string_view keyword);

/// Red, green and blue of a statement with three numbers, or one for all: finite and at least 0.
/// Throws MtlProblem, also for spectral curves and CIE XYZ, for which the format states no white
/// point.
std::array<double, 3> mtl_color(const MtlStatement& statement, std::string_view keyword);

/// `text` with the letters A to Z in lower case.
std::string mtl_lower(std::string_view text);

}  // namespace gonio::material
