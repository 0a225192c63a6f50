// Whether an OpenEXR file is one that may be opened: OpenEXR allocates what a header declares
// before it looks whether the file has as much.
#pragma once

#include <string_view>

namespace gonio::exr {

/// Throws std::runtime_error unless `content` is a scan-line image of one part, uncompressed or
/// compressed by RLE, ZIPS or ZIP, whose attributes lie within the file, whose data window begins
/// at (0, 0), and whose pixels are not more than its bytes can be the compression of: zlib gives at
/// most 1032 bytes for one.
void check_scan_line_file(std::string_view content);

}  // namespace gonio::exr
