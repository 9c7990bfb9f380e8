/// Who hangs on whom. Body 0 is the base; the others are numbered outward, each after its parent.
#pragma once

#include <vector>

namespace wingspread {

/// Any tree, known at run time.
struct Tree {
  std::vector<int> parent;       ///< of body i; −1 for the base
  std::vector<int> first_child;  ///< of body i; −1 if it has none
  std::vector<int> next_sibling; ///< of body i; −1 if it is the last

  [[nodiscard]] int bodies() const { return static_cast<int>(parent.size()) - 1; }
  [[nodiscard]] int parent_of(int i) const { return parent[i]; }

  template <class Visit> void for_each_child(int i, Visit visit) const {
    for (int j = first_child[i]; j >= 0; j = next_sibling[j]) visit(j);
  }
};

/// A chain of N bodies, known to the compiler: loops unroll, intermediate results stay in registers.
template <int N> struct Chain {
  [[nodiscard]] static constexpr int bodies() { return N; }
  [[nodiscard]] static constexpr int parent_of(int i) { return i - 1; }

  template <class Visit> static constexpr void for_each_child(int i, Visit visit) {
    if (i < N) visit(i + 1);
  }
};

/// The tree in which body i's parent is parents[i] (parents[0] = −1, parents[i] < i).
[[nodiscard]] inline Tree make_tree(std::vector<int> parents) {
  const int count = static_cast<int>(parents.size());
  Tree tree{std::move(parents), std::vector<int>(count, -1), std::vector<int>(count, -1)};
  for (int i = count - 1; i > 0; --i) { // backwards, so that children are visited in rising order
    int& first = tree.first_child[tree.parent[i]];
    tree.next_sibling[i] = first;
    first = i;
  }
  return tree;
}

[[nodiscard]] inline bool is_chain(const Tree& tree) {
  for (int i = 1; i <= tree.bodies(); ++i)
    if (tree.parent[i] != i - 1) return false;
  return true;
}

} // namespace wingspread
