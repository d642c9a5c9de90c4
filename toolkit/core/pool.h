#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace taut {

/// Objects that are costly to make, each in one task's hands at a time: there are as many as tasks
/// run at once. What a task finds in one that another has had depends on the order in which threads
/// come, so results must not depend on it.
template <class Object>
class Pool {
 public:
  explicit Pool(std::function<std::unique_ptr<Object>()> make) : make_(std::move(make)) {}

  /// Gives its object back at the end of its life.
  class Lease {
   public:
    Lease(Pool& pool, std::unique_ptr<Object> object) : pool_(pool), object_(std::move(object)) {}
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    ~Lease() { pool_.give_back(std::move(object_)); }
    Object& operator*() const { return *object_; }

   private:
    Pool& pool_;
    std::unique_ptr<Object> object_;
  };

  /// One that nobody has, or a new one.
  Lease lease() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Object> object = std::move(idle_.back());
        idle_.pop_back();
        return {*this, std::move(object)};
      }
    }
    return {*this, make_()};
  }

 private:
  void give_back(std::unique_ptr<Object> object) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(object));
  }

  std::function<std::unique_ptr<Object>()> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Object>> idle_;
};

}  // namespace taut
