// Reading the typed attributes of an OpenEXR header.
#pragma once

#include <ImfAttribute.h>
#include <ImfHeader.h>
#include <fmt/core.h>

#include <stdexcept>
#include <string_view>

namespace gonio::exr {

/// The value of an attribute that has to be there and of the type. Throws std::runtime_error that
/// names it; `writer` is the command that writes it, for the message.
template <class Attribute>
const auto& value_of(const Imf::Header& header, const char* name, std::string_view writer) {
  const auto found = header.find(name);
  if (found == header.end()) {
    throw std::runtime_error(
        fmt::format("attribute {}: missing, expected one of type {}; `{}` "
                    "writes it",
                    name, Attribute::staticTypeName(), writer));
  }
  const auto* attribute = dynamic_cast<const Attribute*>(&found.attribute());
  if (attribute == nullptr) {
    throw std::runtime_error(fmt::format("attribute {}: found the type {}, expected {}", name,
                                         found.attribute().typeName(),
                                         Attribute::staticTypeName()));
  }
  return attribute->value();
}

}  // namespace gonio::exr
