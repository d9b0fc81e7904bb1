// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <utility>

#include "daemon/base/parallel_chunks.h"
#include "daemon/scene/index/index_tree.h"
#include "daemon/scene/index/node_splitter.h"

namespace camway::scene {

using geometry::Box;

namespace {

/// Larger parts are built as chunks of their own, by any free thread. It does not depend on the
/// number of threads, so the index does not either.
constexpr std::size_t kChunkEntries = 4096;

/// Calls `body(begin, end)` for ranges that together make [0, count).
void for_ranges(unsigned threads, std::size_t count,
                const std::function<void(std::size_t, std::size_t)>& body) {
  constexpr std::size_t kRange = 16384;
  base::for_each_chunk(threads, (count + kRange - 1) / kRange, [&](unsigned, std::size_t range) {
    body(range * kRange, std::min((range + 1) * kRange, count));
  });
}

/// The subtree that one thread builds by itself, without the chunks below it.
struct Chunk {
  /// A node of this chunk that is the root of another chunk.
  struct Link {
    std::uint32_t node;
    std::unique_ptr<Chunk> chunk;
  };

  IndexNode root;
  std::vector<IndexNode>
      nodes;  ///< all but the root; numbers in nodes count from the chunk's first
  std::vector<std::uint32_t> leaf_ends;  ///< leaf i has the entries up to leaf_ends[i]
  std::vector<std::uint32_t> references;
  std::vector<ByteBox> boxes;  ///< boxes of the references
  std::vector<Link> links;
  std::uint32_t depth = 0;

  // Offsets of this chunk's nodes, leaves and references in the index.
  std::uint32_t first_node = 0;
  std::uint32_t first_leaf = 0;
  std::uint32_t first_reference = 0;
};

/// Builds chunks on several threads.
class ChunkBuilder {
 public:
  explicit ChunkBuilder(const NodeSplitter& splitter) : splitter_(splitter) {}

  std::unique_ptr<Chunk> build(IndexPart all, unsigned threads) {
    auto root = std::make_unique<Chunk>();
    const bool is_small = all.entries.size() <= kChunkEntries;
    add({root.get(), std::move(all)});
    // Each of them takes tasks until all are done.
    const unsigned workers = is_small ? 1 : threads;
    base::for_each_chunk(workers, workers, [this](unsigned, std::size_t) { work(); });
    if (failure_) std::rethrow_exception(failure_);
    return root;
  }

 private:
  struct Task {
    Chunk* chunk;
    IndexPart part;
  };
  struct Inner {
    IndexPart part;
    std::vector<IndexPart> children;  ///< empty if it becomes a chunk
  };

  void add(Task task) {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    ++unfinished_;
    changed_.notify_one();
  }

  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return !tasks_.empty() || unfinished_ == 0; });
      if (tasks_.empty()) return;
      Task task = std::move(tasks_.back());
      tasks_.pop_back();
      lock.unlock();
      std::exception_ptr failure;
      try {
        build_chunk(*task.chunk, std::move(task.part));
      } catch (...) {  // out of memory; no exception may leave a thread
        failure = std::current_exception();
      }
      lock.lock();
      if (failure) failure_ = failure;
      if (--unfinished_ == 0) changed_.notify_all();
    }
  }

  void build_chunk(Chunk& chunk, IndexPart part) {
    std::vector<IndexPart> children = splitter_.split(part);
    // A part that cannot be split is the only leaf of its node.
    if (children.empty()) {
      part.is_final = true;
      children.push_back(std::move(part));
    }
    build_node(chunk, chunk.root, std::move(children));
  }

  /// Fills `result`, which is not a node of `chunk` yet, and builds the nodes below it.
  void build_node(Chunk& chunk, IndexNode& result, std::vector<IndexPart> parts) {
    Box box;
    for (const IndexPart& part : parts) {
      box.extend(part.box);
      chunk.depth = std::max(chunk.depth, part.depth);
    }
    std::vector<Inner> inner;
    std::vector<IndexPart> leaves;
    sort_out(parts, inner, leaves);
    IndexNode node;
    node.frame = ByteFrame(box);
    node.node_count = static_cast<std::uint8_t>(inner.size());
    node.child_count = static_cast<std::uint8_t>(parts.size());
    node.first_node = static_cast<std::uint32_t>(chunk.nodes.size());
    node.first_leaf = static_cast<std::uint32_t>(chunk.leaf_ends.size());
    std::size_t slot = 0;
    for (const Inner& child : inner) {
      set_box(node.boxes, slot++, node.frame.outside(child.part.box));
    }
    for (const IndexPart& leaf : leaves) {
      set_box(node.boxes, slot++, node.frame.outside(leaf.box));
      add_leaf(chunk, node.frame, leaf);
    }
    result = node;
    chunk.nodes.resize(chunk.nodes.size() + inner.size());
    build_inner(chunk, node.first_node, inner);
  }

  /// Divides parts into those that become nodes and those that become leaves.
  void sort_out(std::vector<IndexPart>& parts, std::vector<Inner>& inner,
                std::vector<IndexPart>& leaves) const {
    inner.reserve(parts.size());
    leaves.reserve(parts.size());
    for (IndexPart& part : parts) {
      const bool is_large = part.entries.size() > kChunkEntries && !part.is_final;
      std::vector<IndexPart> children;
      if (!is_large) children = splitter_.split(part);
      if (is_large || !children.empty()) {
        inner.push_back({std::move(part), std::move(children)});
      } else {
        leaves.push_back(std::move(part));
      }
    }
  }

  void build_inner(Chunk& chunk, std::uint32_t first, std::vector<Inner>& inner) {
    for (std::size_t i = 0; i < inner.size(); ++i) {
      const auto at = static_cast<std::uint32_t>(first + i);
      if (inner[i].children.empty()) {
        chunk.links.push_back({at, std::make_unique<Chunk>()});
        add({chunk.links.back().chunk.get(), std::move(inner[i].part)});
      } else {
        IndexNode node;
        build_node(chunk, node, std::move(inner[i].children));
        chunk.nodes[at] = node;
      }
    }
  }

  static void add_leaf(Chunk& chunk, const ByteFrame& frame, const IndexPart& leaf) {
    for (const IndexEntry& entry : leaf.entries) {
      chunk.references.push_back(entry.triangle);
      chunk.boxes.push_back(frame.outside(entry.box()));
    }
    chunk.leaf_ends.push_back(static_cast<std::uint32_t>(chunk.references.size()));
  }

  const NodeSplitter& splitter_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Task> tasks_;     ///< guarded by mutex_
  std::size_t unfinished_ = 0;  ///< tasks waiting and running; guarded by mutex_
  std::exception_ptr failure_;  ///< guarded by mutex_
};

unsigned threads_for(const IndexOptions& options) {
  const unsigned wanted =
      options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
  return std::clamp(wanted, 1U, kMaxIndexThreads);
}

IndexPart all_of(std::vector<IndexEntry> entries, const IndexOptions& options) {
  IndexPart all;
  all.entries = std::move(entries);
  all.box = bounds_of(all.entries);
  all.budget = std::max(1.0, options.max_duplication) * static_cast<double>(all.entries.size());
  return all;
}

std::vector<IndexEntry> entries_of(const Mesh& mesh, unsigned threads) {
  std::vector<IndexEntry> entries(mesh.triangles.size());
  for_ranges(threads, entries.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      entries[i] = IndexEntry(geometry::bounds(mesh.triangle(i)), static_cast<std::uint32_t>(i));
    }
  });
  return entries;
}

IndexPart all_of(const Mesh& mesh, const IndexOptions& options) {
  assert(options.threshold >= 1 && options.max_depth <= kMaxIndexDepth);
  return all_of(entries_of(mesh, threads_for(options)), options);
}

/// Concatenates the chunks in the order in which a single thread would reach them.
class IndexAssembler {
 public:
  explicit IndexAssembler(Chunk& root) {
    place(root);
    node_list_.resize(nodes_);
    leaf_begin_.resize(leaves_ + std::size_t{1});
    reference_list_.resize(references_);
    boxes_.resize((references_ + kNodeWidth - 1) / kNodeWidth);
  }

  IndexArrays assemble(unsigned threads) {
    const Chunk& root = *chunks_.front();
    node_list_[0] = moved(root, root.root);
    base::for_each_chunk(threads, chunks_.size(),
                         [this](unsigned, std::size_t i) { copy(*chunks_[i]); });
    leaf_begin_.back() = references_;
    return {std::move(node_list_), std::move(leaf_begin_), std::move(reference_list_),
            std::move(boxes_), depth_};
  }

 private:
  void place(Chunk& chunk) {
    chunk.first_node = nodes_;
    chunk.first_leaf = leaves_;
    chunk.first_reference = references_;
    nodes_ += static_cast<std::uint32_t>(chunk.nodes.size());
    leaves_ += static_cast<std::uint32_t>(chunk.leaf_ends.size());
    references_ += static_cast<std::uint32_t>(chunk.references.size());
    depth_ = std::max(depth_, chunk.depth);
    chunks_.push_back(&chunk);
    for (const Chunk::Link& link : chunk.links) place(*link.chunk);
  }

  static IndexNode moved(const Chunk& chunk, IndexNode node) {
    node.first_node += chunk.first_node;
    node.first_leaf += chunk.first_leaf;
    return node;
  }

  /// Chunks write to separate ranges, so this may run for all of them in parallel.
  void copy(const Chunk& chunk) {
    for (std::size_t i = 0; i < chunk.nodes.size(); ++i) {
      node_list_[chunk.first_node + i] = moved(chunk, chunk.nodes[i]);
    }
    for (const Chunk::Link& link : chunk.links) {
      node_list_[chunk.first_node + link.node] = moved(*link.chunk, link.chunk->root);
    }
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < chunk.leaf_ends.size(); ++i) {
      leaf_begin_[chunk.first_leaf + i] = chunk.first_reference + begin;
      begin = chunk.leaf_ends[i];
    }
    for (std::size_t i = 0; i < chunk.references.size(); ++i) {
      const std::size_t at = chunk.first_reference + i;
      reference_list_[at] = chunk.references[i];
      set_box(boxes_[at / kNodeWidth], at % kNodeWidth, chunk.boxes[i]);
    }
  }

  std::vector<IndexNode> node_list_;
  std::vector<std::uint32_t> leaf_begin_;
  std::vector<std::uint32_t> reference_list_;
  std::vector<ByteBoxes> boxes_;
  std::vector<Chunk*> chunks_;
  std::uint32_t nodes_ = 1;  ///< the root comes first
  std::uint32_t leaves_ = 0;
  std::uint32_t references_ = 0;
  std::uint32_t depth_ = 0;
};

}  // namespace

IndexTree IndexTree::assembled(const NodeSplitter& splitter, IndexPart all, unsigned threads) {
  IndexTree tree;
  if (all.entries.empty()) return tree;
  tree.bounds_ = all.box;
  const std::unique_ptr<Chunk> root = ChunkBuilder(splitter).build(std::move(all), threads);
  tree.arrays_ = IndexAssembler(*root).assemble(threads);
  return tree;
}

IndexTree IndexTree::of_triangles(const Mesh& mesh, const IndexOptions& options) {
  if (mesh.triangles.empty()) return {};
  IndexPart all = all_of(mesh, options);
  const auto splitter = make_octree_splitter(mesh, all.box, options);
  return assembled(*splitter, std::move(all), threads_for(options));
}

IndexTree IndexTree::of_triangles(const Mesh& mesh, const NodeSplitter& splitter,
                                  const IndexOptions& options) {
  return assembled(splitter, all_of(mesh, options), threads_for(options));
}

IndexTree IndexTree::of_boxes(std::span<const Box> boxes) {
  std::vector<IndexEntry> entries;
  entries.reserve(boxes.size());
  for (const Box& box : boxes) {
    entries.emplace_back(box, static_cast<std::uint32_t>(entries.size()));
  }
  const IndexOptions options{.threshold = 1, .threads = 1};
  const auto splitter = make_box_group_splitter(options);
  return assembled(*splitter, all_of(std::move(entries), options), options.threads);
}

std::shared_ptr<const IndexedMesh> IndexedMesh::build(std::shared_ptr<const Mesh> mesh,
                                                      const IndexOptions& options) {
  assert(mesh);
  auto indexed = std::make_shared<IndexedMesh>();
  indexed->tree = IndexTree::of_triangles(*mesh, options);
  indexed->mesh = std::move(mesh);
  return indexed;
}

std::uint64_t IndexTree::memory_bytes() const {
  return arrays_.nodes.size() * sizeof(IndexNode) + arrays_.boxes.size() * sizeof(ByteBoxes) +
         (arrays_.references.size() + arrays_.leaf_begin.size()) * sizeof(std::uint32_t);
}

bool IndexTree::is_same_as(const IndexTree& other) const { return arrays_ == other.arrays_; }

}  // namespace camway::scene
