#pragma once

#include <functional>

#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/trace/free_ends.h"

namespace taut {

/// Passes over points of the separating curve that ends in the free end: pairs of contacts of one
/// surface that have parted from it by one of several distances, and support the model. Ends when
/// `visit` returns true. There may be none, where the method that seeks them does not converge.
void visit_parted(const ContactSystem& system, SupportQuery& query, const FreeEnd& end,
                  const std::function<bool(const CommonSupport&)>& visit);

}  // namespace taut
