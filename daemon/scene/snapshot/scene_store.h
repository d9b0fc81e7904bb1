// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/snapshot/change_ticket.h"
#include "daemon/scene/snapshot/scene_change.h"
#include "daemon/scene/snapshot/scene_journal.h"
#include "daemon/scene/snapshot/snapshot.h"

namespace camway::scene {

/// Limits of a store, so that clients that may change scenes cannot use up the memory.
struct SceneStoreLimits {
  std::size_t scenes = 4096;
  std::size_t objects = 4096;            ///< limit for each scene
  std::uint64_t triangles = 20'000'000;  ///< limit for all scenes together
  /// Limit of the occupancy mirrors of all scenes together.
  std::uint64_t occupancy_bytes = std::uint64_t{4} << 30;
  SceneHistory::Limits history;  ///< limits of the changes of each scene, and of the bytes of all
                                 ///< histories together
};

/// The reason why the store refused a change.
enum class StoreFault : std::uint8_t {
  kNone,
  kUnknownScene,
  kInvalid,
  kLimit,
  kCancelled,
  kFull,     ///< the journal has no room for the change
  kNotKept,  ///< the journal could not keep the change
  kOutrun,   ///< another process changed the scene first; only inside of the store
};

struct StoreResult {
  std::shared_ptr<const Snapshot> snapshot;  ///< newest snapshot; null on error
  StoreFault fault = StoreFault::kNone;
  std::string error;           ///< empty exactly when `snapshot` is set
  Limit limit = Limit::kNone;  ///< limit that was exceeded, for `StoreFault::kLimit`
};

/// A change, or why it cannot be made.
struct MadeChange {
  std::optional<SceneChange> change;
  std::string error = {};      ///< empty exactly when `change` is set
  Limit limit = Limit::kNone;  ///< limit that would be exceeded
};
/// Makes a change of a scene from its newest snapshot.
using ChangeMaker = std::function<MadeChange(const Snapshot& newest)>;

/// The scenes of a daemon by name: the newest snapshot of each, and its history. A snapshot never
/// changes; a change of its scene makes the next one. The revisions of a name only increase, even
/// if its scene is removed and another one takes the name.
///
/// Thread-safe. Changes of one scene are serialised; different scenes change in parallel. The
/// global lock is held only to publish a finished snapshot, so readers never wait for a build.
/// Limits across scenes are checked before a change is kept and published, so no limit is ever
/// exceeded; changes that are still being built do not count. A change that is cancelled before it
/// is committed (`ChangeTicket`) changes nothing.
///
/// With a journal, a change takes effect only once it is durable. A change that repeats a request
/// which the history names (`ChangeNote::request`) changes nothing more. If other processes write
/// the journal too, a change that one of them has outrun is made anew on the newer revision.
class SceneStore {
 public:
  /// Refers to `journal`, which must outlive it; null keeps nothing.
  explicit SceneStore(const SceneStoreLimits& limits = {}, SceneJournal* journal = nullptr)
      : limits_(limits), journal_(journal) {}

  /// Adds a scene that the journal has, with its history. Fails if it exceeds a limit. Requires
  /// that there is no scene of that name.
  StoreResult adopt(SceneHistory history);
  /// Makes scenes that are new begin above this revision.
  void begin_above(std::uint64_t revision);

  /// Adds the scene, or replaces the one of that name; a new history begins. Its revision is the
  /// larger of `snapshot->revision` and the next revision of that name. Requires that `snapshot` is
  /// not null.
  StoreResult put(std::shared_ptr<const Snapshot> snapshot, ChangeNote note = {},
                  const ChangeTicket& ticket = {});

  /// Changes one object of a scene. Requires the same as `changed`.
  StoreResult change(std::string_view scene, SceneChange change, ChangeNote note = {},
                     const ChangeTicket& ticket = {});
  /// Makes a change that depends on the scene, such as adding a scan to a map of it. `make` gets
  /// the newest snapshot, which stays the newest meanwhile; it is called again if another process
  /// has changed the scene first. It must not change scenes. Fails as `make` does.
  StoreResult change(std::string_view scene, const ChangeMaker& make, ChangeNote note = {},
                     const ChangeTicket& ticket = {});

  /// Makes a new revision with the objects of `revision`. If the history does not hold `revision`,
  /// returns an error that names those that it holds.
  StoreResult restore(std::string_view scene, std::uint64_t revision, ChangeNote note = {},
                      const ChangeTicket& ticket = {});

  /// Like `restore`, but puts the objects into scene `other`, as `put` does.
  StoreResult restore_as(std::string_view scene, std::uint64_t revision, std::string other,
                         ChangeNote note = {}, const ChangeTicket& ticket = {});

  /// Returns the newest snapshot of a scene that has a change by this request
  /// (`ChangeNote::request`); null if there is none.
  [[nodiscard]] std::shared_ptr<const Snapshot> changed_by(std::string_view scene,
                                                           const std::string& request) const;

  /// Removes a scene. Returns its last snapshot; neither a snapshot nor a fault if `request`, which
  /// is as `ChangeNote::request`, has removed it before.
  StoreResult remove(std::string_view scene, const ChangeTicket& ticket = {},
                     const std::string& request = "");
  /// Returns whether this request made one of the last removals.
  [[nodiscard]] bool removed_by(const std::string& request) const;
  /// Takes in requests that have removed scenes, of earlier or of other processes.
  void remember_removals(const std::vector<std::string>& requests);

  /// Waits for the changes that other processes have made, as `SceneJournal::catch_up` does.
  /// Returns false without a journal.
  bool catch_up() { return journal_ != nullptr && journal_->catch_up(); }

  /// Changes that another process has made, and kept in the journal, of the newest revision.
  struct OthersChanges {
    SceneChanges changes;
    KeptRevision made;
  };
  struct OthersRemoval {};
  /// Nothing, or a scene that takes the place of the one of that name, or changes of it.
  using OthersWork = std::variant<std::monostate, SceneHistory, OthersChanges, OthersRemoval>;
  /// Makes what `read` returns; the journal does not hear of it. `read` gets the newest
  /// snapshot, null if there is no such scene, which stays the newest meanwhile. Fails as `read`
  /// does, or if a limit is exceeded or the changes do not fit; then changes nothing.
  StoreResult follow(const std::string& scene,
                     const std::function<base::Result<OthersWork>(const Snapshot* newest)>& read);

  /// Replaces the listener, which is called after each change, on the thread that made the change
  /// and never on two threads at a time. It must not change scenes. When this returns, the old
  /// listener is not called any more.
  void on_change(std::function<void()> listener);

  /// The newest snapshot, or null if there is no such scene.
  [[nodiscard]] std::shared_ptr<const Snapshot> find(std::string_view name) const;

  /// The history of a scene, or nothing if there is no such scene.
  [[nodiscard]] std::optional<SceneHistory> history(std::string_view name) const;

  /// The newest snapshot and all revisions that can be restored, oldest first, the newest included.
  /// Null and empty if there is no such scene.
  struct Kept {
    std::shared_ptr<const Snapshot> newest;
    std::vector<KeptRevision> revisions;
  };
  [[nodiscard]] Kept kept(std::string_view name) const;

  /// All scenes in order of name.
  [[nodiscard]] std::vector<std::shared_ptr<const Snapshot>> list() const;

  /// A text for users who asked for an unknown scene: the first names, and the number of others.
  [[nodiscard]] std::string summary() const;

  [[nodiscard]] const SceneStoreLimits& limits() const { return limits_; }

 private:
  /// The amounts that count towards the limits: of one scene, or of all together.
  struct Usage {
    std::uint64_t scenes = 0;
    std::uint64_t triangles = 0;
    std::uint64_t occupancy_bytes = 0;
  };
  struct Entry {
    std::shared_ptr<const Snapshot> newest;
    Usage usage;
    SceneHistory history;
  };
  using Scenes = std::map<std::string, Entry, std::less<>>;

  /// Lock on changes of the scene of that name, which need not exist. Held while this object lives.
  class ChangeLock {
   public:
    ChangeLock(SceneStore& store, std::string_view scene);
    ~ChangeLock();
    ChangeLock(const ChangeLock&) = delete;
    ChangeLock& operator=(const ChangeLock&) = delete;

   private:
    SceneStore& store_;
    std::set<std::string, std::less<>>::iterator scene_;
  };

  static Usage usage_of(const Snapshot& snapshot);
  /// Calls `attempt` until no other process outruns it.
  StoreResult until_not_outrun(std::string_view scene, const std::function<StoreResult()>& attempt);
  StoreResult put_once(std::shared_ptr<const Snapshot> snapshot, ChangeNote note,
                       const ChangeTicket& ticket);
  StoreResult change_once(std::string_view scene, const ChangeMaker& make, const ChangeNote& note,
                          const ChangeTicket& ticket);
  StoreResult restore_once(std::string_view scene, std::uint64_t revision, ChangeNote note,
                           const ChangeTicket& ticket);
  StoreResult remove_once(std::string_view scene, const ChangeTicket& ticket,
                          const std::string& request);
  [[nodiscard]] StoreResult unknown(std::string_view scene) const;
  /// Requires that the caller holds the scene's `ChangeLock` and that `before` is its newest
  /// snapshot.
  StoreResult make_next(const Snapshot& before, SceneChanges changes, ChangeNote note,
                        const ChangeTicket& ticket);

  /// The lowest revision that the next scene of that name may have. Stays valid while its
  /// `ChangeLock` is held.
  [[nodiscard]] std::uint64_t next_revision(std::string_view scene) const;

  /// The oldest revision of a scene that can be restored. Requires that the caller holds its
  /// `ChangeLock`, and that it exists.
  [[nodiscard]] std::uint64_t oldest_kept(const Snapshot& newest) const;

  /// Checks the limits, commits the ticket, and counts `next` in place of the scene of its name.
  /// Returns the reason if that is not possible.
  std::optional<StoreResult> reserve(const Snapshot& next, const Usage& usage,
                                     const ChangeTicket& ticket);
  /// Takes back what `reserve` counted, because the journal could not keep the change.
  StoreResult not_kept(const Snapshot& next, const Usage& usage, Keeping keeping);
  /// Puts an entry whose usage is counted, and calls the listener.
  StoreResult publish(Entry entry);
  /// Makes `next` the newest snapshot of its scene, whose usage is counted, and calls the listener.
  StoreResult publish_changes(std::shared_ptr<const Snapshot> next, const Usage& usage,
                              SceneChanges changes, ChangeNote note);
  /// Takes a scene out and calls the listener.
  void take_out(std::string_view scene, std::uint64_t last_revision);

  // The kinds of work of `follow`. They require that the caller holds the scene's `ChangeLock`.
  StoreResult take(const std::string& scene, SceneHistory history);
  StoreResult take(const std::string& scene, OthersChanges work);
  StoreResult take(const std::string& scene, OthersRemoval);
  StoreResult take(const std::string& scene, std::monostate);

  // The next four functions require that mutex_ is held.

  /// The usage of the scene of that name; empty if it does not exist.
  [[nodiscard]] Usage usage_before(std::string_view scene) const;

  /// Checks the limits as if `next` replaced the scene of its name. Returns `StoreFault::kLimit`
  /// and an error if a limit would be exceeded, and nothing otherwise.
  [[nodiscard]] std::optional<StoreResult> over_limit(const Snapshot& next,
                                                      const Usage& usage) const;
  /// Subtracts `before` from `total_` and adds `after`. An empty `Usage` stands for a scene that
  /// does not exist.
  void count(const Usage& before, const Usage& after);
  /// Drops the oldest changes of the largest histories until all together are within
  /// `limits_.history.bytes`.
  void forget_history();

  /// Calls the listener, if there is one.
  void notify();

  const SceneStoreLimits limits_;
  SceneJournal* const journal_;
  std::mutex notify_mutex_;         ///< held while the listener is called; locked before mutex_
  std::function<void()> listener_;  ///< guarded by notify_mutex_
  mutable std::mutex mutex_;        ///< guards all below; held for short times only
  std::condition_variable change_ended_;
  std::set<std::string, std::less<>> changing_;  ///< scenes whose `ChangeLock` is held
  Scenes scenes_;
  Usage total_;                        ///< sum over `scenes_`, and what is reserved
  std::uint64_t highest_removed_ = 0;  ///< highest revision of removed scenes
  std::deque<std::string> removals_;   ///< requests of the last removals, oldest first
};

}  // namespace camway::scene
