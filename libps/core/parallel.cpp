// SPDX-License-Identifier: BSD-3-Clause
#include "libps/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

namespace ps {
namespace {

thread_local bool inside_loop = false;

/// One loop in flight: workers take the next iteration until none is left.
struct Loop {
  std::size_t count = 0;
  const std::function<void(std::size_t)>* body = nullptr;
  std::atomic<std::size_t> next{0};
  std::mutex error_mutex;
  std::size_t error_index = std::numeric_limits<std::size_t>::max();
  std::exception_ptr error;

  void run() {
    inside_loop = true;
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        (*body)(i);
      } catch (...) {
        next = count;  // all below i have begun; no other can change which error is thrown
        const std::lock_guard<std::mutex> lock(error_mutex);
        if (i < error_index) {
          error_index = i;
          error = std::current_exception();
        }
      }
    }
    inside_loop = false;
  }
};

/// Threads that wait for loops. One loop at a time; a second caller waits its turn.
class Pool {
 public:
  ~Pool() { resize(1); }

  void resize(int count) {
    const std::lock_guard<std::mutex> turn(turn_mutex_);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& worker : workers_) worker.join();
    workers_.clear();
    stopping_ = false;
    for (int i = 1; i < count; ++i) {
      workers_.emplace_back([this, seen = generation_] { work(seen); });
    }
  }

  void run(Loop& loop) {
    const std::lock_guard<std::mutex> turn(turn_mutex_);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      loop_ = &loop;
      ++generation_;
    }
    wake_.notify_all();
    loop.run();
    std::unique_lock<std::mutex> lock(mutex_);
    loop_ = nullptr;  // a worker that wakes only now is not waited for
    done_.wait(lock, [this] { return busy_ == 0; });
  }

 private:
  void work(std::size_t seen) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      wake_.wait(lock, [&] { return stopping_ || (loop_ != nullptr && generation_ != seen); });
      if (stopping_) return;
      seen = generation_;
      Loop* loop = loop_;
      ++busy_;
      lock.unlock();
      loop->run();
      lock.lock();
      if (--busy_ == 0) done_.notify_all();
    }
  }

  std::mutex turn_mutex_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  std::vector<std::thread> workers_;
  Loop* loop_ = nullptr;
  std::size_t generation_ = 0;
  int busy_ = 0;  ///< workers inside a loop
  bool stopping_ = false;
};

int core_count() { return std::max(1u, std::thread::hardware_concurrency()); }

std::atomic<int> thread_count{0};

Pool& pool() {
  static Pool instance;
  static std::once_flag sized;
  std::call_once(sized, [] { instance.resize(threads()); });
  return instance;
}

}  // namespace

void set_threads(int count) {
  pool();
  thread_count = count > 0 ? count : core_count();
  pool().resize(thread_count);
}

int threads() { return thread_count > 0 ? thread_count.load() : core_count(); }

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  Loop loop;
  loop.count = count;
  loop.body = &body;
  if (inside_loop || count < 2 || threads() == 1) {
    const bool outer = inside_loop;
    loop.run();
    inside_loop = outer;
  } else {
    pool().run(loop);
  }
  if (loop.error) std::rethrow_exception(loop.error);
}

void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  parallel_for(chunks, [&](std::size_t i) { body(i * chunk, std::min(count, (i + 1) * chunk)); });
}

}  // namespace ps
