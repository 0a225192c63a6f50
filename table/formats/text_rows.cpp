#include "table/formats/text_rows.h"

#include <fmt/core.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "table/file_error.h"
#include "table/formats/number_text.h"
#include "table/formats/row_fields.h"
#include "table/formats/sample_writer.h"
#include "table/formats/text_lines.h"
#include "table/parallel.h"

namespace gonio::table {

namespace {

constexpr std::size_t block_size = std::size_t{1} << 20;

/// Whole lines of the text.
struct Block {
  const char* begin;
  const char* end;
  std::size_t lines = 0;
  std::size_t rows = 0;
  std::size_t first_line = 0;
  std::size_t first_row = 0;
};

const char* behind_line(const char* at, const char* end) {
  const void* found = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
  return found == nullptr ? end : static_cast<const char*>(found) + 1;
}

/// True if the line at `at` is neither blank nor a comment.
bool is_row(const char* at, const char* end) {
  const char* first = skip_blanks(at, end);
  return first != end && *first != '\n' && *first != '#';
}

std::vector<Block> cut_into_blocks(std::string_view text) {
  std::vector<Block> blocks;
  const char* const end = text.data() + text.size();
  for (const char* begin = text.data(); begin != end;) {
    const bool is_last = static_cast<std::size_t>(end - begin) <= block_size;
    const char* block_end = is_last ? end : behind_line(begin + block_size, end);
    blocks.push_back({begin, block_end});
    begin = block_end;
  }
  return blocks;
}

void count_lines(Block& block) {
  for (const char* at = block.begin; at != block.end;) {
    if (is_row(at, block.end)) ++block.rows;
    at = behind_line(at, block.end);
    ++block.lines;
  }
}

/// Gives each block the number of its first line and first row; returns the number of rows.
std::size_t number_blocks(std::vector<Block>& blocks, std::size_t first_line) {
  std::size_t row = 0;
  for (Block& block : blocks) {
    block.first_line = first_line;
    block.first_row = row;
    first_line += block.lines;
    row += block.rows;
  }
  return row;
}

/// Gives `array` its size, in huge pages where the system has them: to touch fresh memory page by
/// page would take a fifth of the time of reading a big table.
void resize_fresh(std::vector<double>& array, std::size_t size) {
  array.reserve(size);
#ifdef MADV_HUGEPAGE
  constexpr std::size_t huge_page = std::size_t{1} << 21;
  auto* const begin = reinterpret_cast<char*>(array.data());
  const std::size_t before =
      (huge_page - reinterpret_cast<std::uintptr_t>(begin) % huge_page) % huge_page;
  const std::size_t bytes = size * sizeof(double);
  if (before < bytes) {
    madvise(begin + before, (bytes - before) / huge_page * huge_page, MADV_HUGEPAGE);
  }
#endif
  array.resize(size);
}

/// Gives every array of the table its size; in parallel, since fresh memory is slow to touch.
void resize(SampleTable& table, const Columns& columns, std::size_t rows, bool angle_text,
            int threads) {
  table.values.resize(columns.values.size());
  table.sigma.resize(columns.sigmas.size());
  std::vector<std::vector<double>*> arrays{&table.wi.x, &table.wi.y, &table.wi.z,
                                           &table.wo.x, &table.wo.y, &table.wo.z};
  for (std::vector<double>& values : table.values) arrays.push_back(&values);
  for (std::vector<double>& sigmas : table.sigma) arrays.push_back(&sigmas);
  if (columns.weight) arrays.push_back(&table.weight);
  parallel_for(arrays.size(), threads, [&](std::size_t i) { resize_fresh(*arrays[i], rows); });
  table.mask.resize(rows, MaskReason::none);
  if (angle_text) table.angle_text.resize(rows);
}

std::string angle_text(std::string_view line, const TextRows& rows) {
  const std::vector<std::string_view> fields = split_fields(line, rows.separator);
  const std::array<std::size_t, 4>& at = rows.columns.angles;
  return fmt::format("{},{},{},{}", fields[at[0]], fields[at[1]], fields[at[2]], fields[at[3]]);
}

/// What the first bad line of a block is; line 0 if there is none.
struct BadLine {
  std::size_t number = 0;
  RowProblem problem;
  std::string_view text;
};

BadLine read_block(const Block& block, const TextRows& rows, const SampleWriter& writer,
                   SampleTable& table) {
  const Columns& columns = rows.columns;
  std::vector<double> all_fields(columns.names.size());
  all_fields.insert(all_fields.end(), columns.constants.begin(), columns.constants.end());
  const std::span<double> fields(all_fields.data(), columns.names.size());
  std::size_t line = block.first_line;
  std::size_t row = block.first_row;
  for (const char* at = block.begin; at != block.end; ++line) {
    const char* const begin = at;
    if (!is_row(at, block.end)) {
      at = behind_line(at, block.end);
      continue;
    }
    RowProblem problem = read_fields(at, block.end, rows.separator, fields, columns.ignored);
    if (problem.fault == RowFault::none) problem = writer.write(all_fields, row);
    at = behind_line(at, block.end);
    const std::string_view text(begin, static_cast<std::size_t>(at - begin));
    if (problem.fault != RowFault::none)
      return {line, problem, trimmed(text.substr(0, text.find('\n')))};
    if (!table.angle_text.empty())
      table.angle_text[row] = angle_text(text.substr(0, text.find('\n')), rows);
    ++row;
  }
  return {};
}

/// Reads all blocks; returns the first bad line of the file.
BadLine read_blocks(const std::vector<Block>& blocks, const TextRows& rows,
                    const SampleWriter& writer, SampleTable& table, int threads) {
  std::vector<BadLine> bad(blocks.size());
  std::atomic<std::size_t> first_bad = blocks.size();
  parallel_for(blocks.size(), threads, [&](std::size_t b) {
    if (b > first_bad.load(std::memory_order_relaxed)) return;
    bad[b] = read_block(blocks[b], rows, writer, table);
    if (bad[b].number == 0) return;
    std::size_t seen = first_bad.load();
    while (b < seen && !first_bad.compare_exchange_weak(seen, b)) {
    }
  });
  return first_bad == blocks.size() ? BadLine{} : bad[first_bad];
}

}  // namespace

AngleExtent angle_extent(const TextRows& rows) {
  AngleExtent extent;
  LineReader lines(rows.text);
  for (std::string_view line; lines.next(line);) {
    if (line.starts_with('#')) continue;
    const std::vector<std::string_view> fields = split_fields(line, rows.separator);
    for (std::size_t a = 0; a < rows.columns.angles.size(); ++a) {
      if (rows.columns.angles[a] >= fields.size()) continue;
      const std::string_view field = fields[rows.columns.angles[a]];
      const char* at = field.data();
      double angle = 0;
      if (read_number(at, at + field.size(), angle) != NumberText::number) continue;
      double& largest = a == theta_i || a == theta_o ? extent.theta : extent.phi;
      largest = std::max(largest, std::abs(angle));
    }
  }
  return extent;
}

void read_rows(const TextRows& rows, Quantity quantity, AngleUnit unit, const ReadOptions& options,
               SampleTable& table) {
  table.channels = rows.columns.channels;
  std::vector<Block> blocks = cut_into_blocks(rows.text);
  parallel_for(blocks.size(), options.threads, [&](std::size_t b) { count_lines(blocks[b]); });
  const std::size_t count = number_blocks(blocks, rows.first_line);
  // A constant angle has no text in the file.
  const bool keeps_text = options.keep_angle_text && rows.columns.constants.empty();
  resize(table, rows.columns, count, keeps_text, options.threads);
  const SampleWriter writer(rows.columns, quantity, unit, table);
  const BadLine bad = read_blocks(blocks, rows, writer, table, options.threads);
  if (bad.number != 0) {
    throw FileError(explain(bad.problem, rows, unit, bad.number, bad.text));
  }
  if (table.size() == 0) {
    throw FileError(fmt::format(
        "{}: no row of numbers behind the header: name a file that holds samples", rows.path));
  }
}

}  // namespace gonio::table
