#include "damage.h"

#include "loop.h"

namespace trimtab::ig {

void Damage::look(std::uint64_t failedPages) {
  tell(database_->damage());
  if (failedPages == failedPages_) return;
  failedPages_ = failedPages;
  tell(renderer_.pageFailures());
}

void Damage::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  failedPages_ = 0;
  before_ += told_.size();
  told_.clear();
}

void Damage::tell(const Findings& findings) {
  for (const Finding& finding : findings)
    if (told_.insert(toString(finding)).second) report({finding});
}

}  // namespace trimtab::ig
