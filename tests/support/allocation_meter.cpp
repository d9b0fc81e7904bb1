// SPDX-License-Identifier: MIT
#include "tests/support/allocation_meter.h"

#include <cstdlib>
#include <new>

namespace {

thread_local std::size_t allocated_bytes = 0;

void* allocate(std::size_t size) {
  allocated_bytes += size;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace camway::testing {

AllocationMeter::AllocationMeter() : before_(allocated_bytes) {}

std::size_t AllocationMeter::bytes() const { return allocated_bytes - before_; }

}  // namespace camway::testing
