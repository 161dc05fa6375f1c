//! Rings in a directed graph, whose nodes are numbered from 0.

use std::collections::{BTreeSet, VecDeque};

/// Groups of two nodes or more that can all be reached from each other.
pub(super) fn groups(graph: &[BTreeSet<usize>]) -> Vec<Vec<usize>> {
    let reached: Vec<BTreeSet<usize>> =
        (0..graph.len()).map(|from| reachable(graph, from)).collect();
    let mut groups = Vec::new();
    let mut grouped = BTreeSet::new();
    for node in 0..graph.len() {
        let mutual =
            |other: &usize| reached[node].contains(other) && reached[*other].contains(&node);
        let group: Vec<usize> = (0..graph.len()).filter(mutual).collect();
        if group.len() > 1 && grouped.insert(group.clone()) {
            groups.push(group);
        }
    }
    groups
}

/// The nodes that can be reached from a node in one step or more.
fn reachable(graph: &[BTreeSet<usize>], from: usize) -> BTreeSet<usize> {
    let mut reached = BTreeSet::new();
    let mut queue: Vec<usize> = vec![from];
    while let Some(node) = queue.pop() {
        queue.extend(graph[node].iter().copied().filter(|next| reached.insert(*next)));
    }
    reached
}

/// The shortest ring within a group, beginning at its lowest node.
pub(super) fn shortest(graph: &[BTreeSet<usize>], group: &[usize]) -> Vec<usize> {
    let rings = group.iter().filter_map(|start| ring_from(graph, *start));
    rings.min_by_key(Vec::len).unwrap_or_default()
}

/// The shortest ring through `start`.
fn ring_from(graph: &[BTreeSet<usize>], start: usize) -> Option<Vec<usize>> {
    let mut before = vec![None; graph.len()];
    let mut queue = VecDeque::from([start]);
    while let Some(node) = queue.pop_front() {
        if graph[node].contains(&start) && node != start {
            let mut ring = vec![node];
            while let Some(previous) = before[*ring.last()?] {
                ring.push(previous);
            }
            ring.reverse();
            return Some(ring);
        }
        for next in &graph[node] {
            if *next != start && before[*next].is_none() {
                before[*next] = Some(node);
                queue.push_back(*next);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(edges: &[(usize, usize)]) -> Vec<BTreeSet<usize>> {
        let mut graph = vec![BTreeSet::new(); 7];
        for (from, to) in edges {
            graph[*from].insert(*to);
        }
        graph
    }

    #[test]
    fn groups_are_separated_and_trees_are_free() {
        let tree = graph(&[(0, 1), (0, 2), (1, 3), (2, 3), (3, 4)]);
        assert_eq!(groups(&tree), Vec::<Vec<usize>>::new());
        let rings =
            graph(&[(0, 1), (1, 0), (1, 2), (2, 3), (3, 4), (4, 2), (4, 3), (5, 5), (6, 0)]);
        assert_eq!(groups(&rings), [vec![0, 1], vec![2, 3, 4]]);
    }

    #[test]
    fn the_shortest_ring_is_found() {
        let rings = graph(&[(0, 1), (1, 2), (2, 3), (3, 0), (3, 4), (4, 2)]);
        assert_eq!(shortest(&rings, &groups(&rings)[0]), [2, 3, 4]);
        let pair = graph(&[(0, 1), (1, 2), (2, 0), (2, 1)]);
        assert_eq!(shortest(&pair, &groups(&pair)[0]), [1, 2]);
    }
}
