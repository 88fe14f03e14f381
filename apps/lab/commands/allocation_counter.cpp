// SPDX-License-Identifier: Apache-2.0
#include "allocation_counter.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define TELEMIME_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TELEMIME_SANITIZED
#endif

#ifdef TELEMIME_SANITIZED

namespace telemime {

std::optional<std::uint64_t> heap_allocations() {
  return std::nullopt;
}

}  // namespace telemime

#else

#include <atomic>
#include <cstdlib>
#include <new>

namespace telemime {
namespace {

std::atomic<std::uint64_t>& counter() {
  static constinit std::atomic<std::uint64_t> count{0};
  return count;
}

// nullptr when there is no memory. `alignment` 0: that of malloc.
void* counted(std::size_t size, std::size_t alignment) noexcept {
  counter().fetch_add(1, std::memory_order_relaxed);
  size = size > 0 ? size : 1;
  if (alignment == 0) {
    return std::malloc(size);
  }
  void* memory = nullptr;
  alignment = alignment < sizeof(void*) ? sizeof(void*) : alignment;
  return posix_memalign(&memory, alignment, size) == 0 ? memory : nullptr;
}

// As the standard asks: the new handler is called until there is memory, and without one it throws.
void* counted_or_throw(std::size_t size, std::size_t alignment) {
  void* memory = counted(size, alignment);
  while (memory == nullptr) {
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) {
      throw std::bad_alloc();
    }
    handler();
    memory = counted(size, alignment);
  }
  return memory;
}

void* counted_or_null(std::size_t size, std::size_t alignment) noexcept {
  try {
    return counted_or_throw(size, alignment);
  } catch (...) {
    return nullptr;
  }
}

}  // namespace

std::optional<std::uint64_t> heap_allocations() {
  return counter().load(std::memory_order_relaxed);
}

}  // namespace telemime

// The forms for arrays call these.
void* operator new(std::size_t size) {
  return telemime::counted_or_throw(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return telemime::counted_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return telemime::counted_or_null(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t& /*tag*/) noexcept {
  return telemime::counted_or_null(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, const std::nothrow_t& /*tag*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t /*alignment*/, const std::nothrow_t& /*tag*/) noexcept {
  std::free(memory);
}

#endif
