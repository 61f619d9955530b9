// SPDX-License-Identifier: MIT
// Where a product comes from, one row each: product,index,stamp_ns,origins - origins as
// topic#index/item@offset_ns with ; between them, the offset from the stamp of the product; without a number
// where the index is not known, and without /item where the whole message counts.
#pragma once

#include <optional>
#include <string>

#include "atlas/sensor/products.hpp"

namespace atlas {

std::string originsCsvHeader();
std::string originsCsvRow(const ProductOrigins& product);
/// The other way; nullopt for a row that is not of this form.
std::optional<ProductOrigins> parseOriginsRow(const std::string& row);

}  // namespace atlas
