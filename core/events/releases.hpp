/// Holds: hinges that are locked at their stowed angles until a time, or until an event of another hinge.
///
/// A rigidly held hinge is a locked hinge of the recursion (locked.hpp) without a limit. An elastic hold adds a spring
/// and a damper about the stowed angle to the hinge's own laws; if the hinge reaches its latched angle in spite of it, it
/// latches. At a release the state is continuous, and the hinge may stick by its own friction (contact.hpp).
#pragma once

#include "core/dense/step.hpp"
#include "core/events/latches.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace wingspread {

/// The holds of one run.
template <class T, class AnySystem> class Releases {
public:
  explicit Releases(AnySystem& system) : system_(system) {}

  /// Holds the hinges at the start of a run, except those whose release is due at time 0.
  void start() {
    due_.assign(size(), T(never));
    held_ = 0;
    for (int pass = 1; pass < size(); ++pass) // as many as holds may wait for each other
      for (int i = 1; i < size(); ++i)
        if (is_due_at_start(i)) due_[i] = terms(i).time + terms(i).delay;
    for (int i = 1; i < size(); ++i) {
      const ReleaseTerms<T>& hold = terms(i);
      if (!hold.present || !(due_[i] > T(0))) continue;
      if (hold.is_elastic)
        system_.restrain(i, true);
      else
        system_.set_contact(i, Contact::held);
      ++held_;
      system_.writable_workspace().watches[i] =
          hold.fails == T(0) && hold.event == Release::Event::passed;
    }
    find_next();
  }

  /// Number of hinges that are held.
  [[nodiscard]] int held() const { return held_; }
  /// The time of the next release that is certain, s; `never` without one.
  [[nodiscard]] const T& next() const { return next_; }

  /// The first s in [0, 1] at which hinge i's hold sees the angle for which it waits; none if it does not.
  [[nodiscard]] std::optional<T> first_passage(const Step<T>& step, int i) const {
    if (!watches(i)) return std::nullopt;
    Quintic<T> past = step.distance(system_.layout().angle(terms(i).after),
                                    system_.layout().freedoms(), terms(i).angle);
    const T& sense = system_.wing().hinges[terms(i).after].sense;
    for (T& c : past) c = sense * c;
    return first_nonnegative(past);
  }
  /// Signed distance past that angle, rad, in the deploying sense of the hinge that moves.
  [[nodiscard]] T passed_by(const State<T>& x, int i) const {
    const int k = terms(i).after;
    return system_.wing().hinges[k].sense * (x[system_.layout().angle(k)] - terms(i).angle);
  }
  /// The hinge that moves, for the hold of hinge i.
  [[nodiscard]] int seen_by(int i) const { return terms(i).after; }

  /// Lets go the holds that are due at the start of a step, by reached_at.
  /// @param due the hinge whose hold sees its angle; 0: none
  /// @param record  of all latches so far; releases are appended
  /// @return whether any hold let go
  bool release_due(int due, const Step<T>& step, LatchRecord& record) {
    if (held_ == 0) return false;
    bool any = false;
    for (bool again = true; again;) { // a release may be the event for which another hold waits
      again = false;
      for (int i = 1; i < size(); ++i) {
        if (!is_held(i)) continue;
        schedule(i, due, step, record);
        if (!(due_[i] <= reached_at(step.t))) continue;
        if (system_.is_restrained(i))
          system_.restrain(i, false);
        else
          system_.set_contact(i, Contact::none);
        system_.start_motor(i, step.t);
        system_.writable_workspace().watches[i] = false;
        --held_;
        record.releases.push_back(hinge_event(system_.wing(), system_.layout(), step.x, step.t, i));
        any = again = true;
      }
    }
    find_next();
    return any;
  }

  /// Whether a hold may still let go, before t_end or after, where no open hinge will latch any more.
  /// @param rests whether no hinge will move any more
  [[nodiscard]] bool may_release(bool rests) const {
    for (int i = 1; held_ > 0 && i < size(); ++i)
      if (is_held(i) && (due_[i] < T(never) || (watches(i) && !rests && awaited_hinge_moves(i))))
        return true;
    return false;
  }

  /// Hinges with a latch that are held rigidly, so that they cannot latch.
  [[nodiscard]] int latches_held() const {
    int count = 0;
    for (int i = 1; held_ > 0 && i < size(); ++i)
      count += system_.is_held(i) && system_.wing().hinges[i].has_latch;
    return count;
  }

  /// The held hinges to blame, in the scene's numbering: those whose hold waits for no other held hinge;
  /// all, where holds wait for each other.
  [[nodiscard]] std::vector<int> never_released() const {
    std::vector<int> first, all;
    for (int i = 1; held_ > 0 && i < size(); ++i) {
      if (!is_held(i)) continue;
      const bool waits = terms(i).after != 0 && terms(i).fails == T(0) && is_held(terms(i).after);
      (waits ? all : first).push_back(system_.wing().hinge_of[i]);
    }
    std::vector<int>& blamed = first.empty() ? all : first;
    std::sort(blamed.begin(), blamed.end());
    return blamed;
  }

  /// The held hinges, in the scene's numbering, whose hold may let go after t_end.
  /// @param no_latch whether no open hinge will latch any more @param rests as of may_release
  [[nodiscard]] std::vector<int> may_release_later(bool no_latch, bool rests) const {
    std::vector<int> later;
    for (int i = 1; held_ > 0 && i < size(); ++i)
      if (is_held(i) && !never_lets_go(i, no_latch, rests))
        later.push_back(system_.wing().hinge_of[i]);
    return later;
  }

  /// Whether a hold holds hinge i, rigidly or elastically.
  [[nodiscard]] bool is_held(int i) const { return system_.is_held(i) || system_.is_restrained(i); }

private:
  [[nodiscard]] int size() const { return static_cast<int>(system_.wing().releases.size()); }
  [[nodiscard]] const ReleaseTerms<T>& terms(int i) const { return system_.wing().releases[i]; }
  [[nodiscard]] bool watches(int i) const { return system_.work().watches[i] != 0; }
  /// Whether it is known before the start when the hold of hinge i lets go.
  [[nodiscard]] bool is_due_at_start(int i) const {
    const ReleaseTerms<T>& hold = terms(i);
    if (!hold.present || hold.fails != T(0)) return false;
    return hold.event == Release::Event::time ||
           (hold.event == Release::Event::released && !(due_[hold.after] > T(0)));
  }
  /// Whether the hold of hinge i, which is held, never lets go. If what it waits for does not happen while that hinge is
  /// held, that hinge's hold decides.
  [[nodiscard]] bool never_lets_go(int i, bool no_latch, bool rests) const {
    for (int passed = 0; passed < size(); ++passed) {
      const ReleaseTerms<T>& hold = terms(i);
      if (hold.fails != T(0)) return true;
      if (due_[i] < T(never)) return false;
      if (hold.after == 0) return true;
      if (awaited_hinge_moves(i) && ((hold.event == Release::Event::passed && !rests) ||
                                     (hold.event == Release::Event::latched && !no_latch)))
        return false;
      if (!is_held(hold.after)) return true;
      i = hold.after;
    }
    return true; // holds that wait for each other
  }
  /// Whether the hinge for which the hold of hinge i waits may turn: it is free, or held elastically.
  [[nodiscard]] bool awaited_hinge_moves(int i) const { return !system_.is_held(terms(i).after); }

  /// Notes when the hold of hinge i lets go, once that is known.
  void schedule(int i, int due, const Step<T>& step, const LatchRecord& record) {
    const ReleaseTerms<T>& hold = terms(i);
    if (due_[i] < T(never) || hold.fails != T(0) || hold.event == Release::Event::time) return;
    const auto is_of_other = [&](const auto& event) {
      return event.hinge == system_.wing().hinge_of[hold.after];
    };
    bool happened = false;
    if (hold.event == Release::Event::latched)
      happened = std::any_of(record.latches.begin(), record.latches.end(), is_of_other);
    else if (hold.event == Release::Event::released)
      happened = std::any_of(record.releases.begin(), record.releases.end(), is_of_other);
    else
      happened = i == due || passes_now(step, i);
    if (!happened) return;
    due_[i] = step.t + hold.delay;
    system_.writable_workspace().watches[i] = false;
  }

  [[nodiscard]] bool passes_now(const Step<T>& step, int i) const {
    const int k = terms(i).after;
    const T rate = system_.wing().hinges[k].sense * step.x[system_.layout().rate(k)];
    return engages_at(step.t, passed_by(step.x, i), rate);
  }

  void find_next() {
    next_ = T(never);
    for (int i = 1; held_ > 0 && i < size(); ++i)
      if (is_held(i)) next_ = smaller(next_, due_[i]);
  }

  AnySystem& system_;
  std::vector<T> due_; ///< 1 … n: when the hold lets go, s; `never`: not known yet
  T next_ = T(never);
  int held_ = 0;
};

} // namespace wingspread
