//! A part of problem (14) that can be solved by itself.

use super::error::ConsistencyError;
use super::groups::{FREE, Groups};
use super::input::AngleNorm;
use super::program::{Program, Solved, rooms};
use super::system::System;
use crate::progress::Watch;
use seamstress_linalg::{Buckets, NotPositiveDefinite};
use std::f64::consts::{FRAC_PI_2, PI};

/// Some triangles, with the groups at their corners. Corners of these groups in other triangles keep their
/// angles.
pub(super) struct Piece {
    /// Number of each corner in the whole problem, three corners per triangle.
    pub(super) corners: Vec<u32>,
    /// Member of each corner, or [`FREE`].
    pub(super) member: Vec<u32>,
    /// Angle given at each corner, radians.
    pub(super) given: Vec<f64>,
    /// What the angles given in each triangle lack of pi.
    pub(super) lack: Vec<f64>,
    pub(super) members: Vec<Member>,
    /// Corners that no group constrains.
    pub(super) free: Vec<u32>,
    pub(super) balances: Vec<Balance>,
}

/// A group with corners in a piece.
pub(super) struct Member {
    /// Its number in the whole problem.
    pub(super) group: u32,
    /// Its corners in the piece.
    pub(super) corners: Vec<u32>,
    /// Sum of their angles at no change of the index, radians.
    pub(super) full_angle: f64,
    /// Sum of the angles given at them.
    pub(super) given: f64,
    /// Changes of the index that are allowed.
    pub(super) range: (i32, i32),
}

impl Member {
    /// Sum of its corners' angles at a change of the index.
    pub(super) fn sum(&self, change: i32) -> f64 {
        self.full_angle - FRAC_PI_2 * f64::from(change)
    }

    /// Angle that its corners gain together at a change of the index.
    pub(super) fn gain(&self, change: i32) -> f64 {
        self.sum(change) - self.given
    }
}

/// Members among which index moves and that nothing leaves: their changes have this sum.
pub(super) struct Balance {
    pub(super) members: Vec<u32>,
    pub(super) sum: i32,
}

/// The whole problem, to take pieces from.
pub(super) struct Whole<'a> {
    pub(super) groups: &'a Groups,
    /// Group of each corner.
    pub(super) group: &'a [u32],
    /// Angle given at each corner, radians.
    pub(super) given: &'a [f64],
    /// Corners by group.
    by_group: Buckets,
}

impl<'a> Whole<'a> {
    pub(super) fn new(groups: &'a Groups, system: &'a System, given: &'a [f64]) -> Self {
        let free = groups.len() as u32;
        let keys: Vec<u32> = system.group.iter().map(|&g| g.min(free)).collect();
        let by_group = Buckets::new(groups.len() + 1, &keys);
        Self { groups, group: &system.group, given, by_group }
    }

    /// Corners of a group.
    pub(super) fn corners(&self, group: u32) -> &[u32] {
        self.by_group.of(group as usize)
    }

    /// The piece of some triangles, ascending, at the present changes and angles. Only the indices of the groups
    /// marked may change.
    pub(super) fn piece(
        &self,
        triangles: &[u32],
        may_change: impl Fn(u32) -> bool,
        change: &[i32],
        angles: &[f64],
    ) -> Piece {
        let corners: Vec<u32> =
            triangles.iter().flat_map(|&t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mut found: Vec<u32> = corners.iter().map(|&c| self.group[c as usize]).collect();
        found.sort_unstable();
        found.dedup();
        found.retain(|&g| g != FREE);
        let place = |g: u32| found.binary_search(&g).map_or(FREE, |place| place as u32);
        let member: Vec<u32> = corners.iter().map(|&c| place(self.group[c as usize])).collect();
        let given: Vec<f64> = corners.iter().map(|&c| self.given[c as usize]).collect();
        let mut members: Vec<Member> = found
            .iter()
            .map(|&g| {
                let group = &self.groups.list[g as usize];
                let now = change[g as usize];
                let outside = self.corners(g).iter();
                let outside = outside.filter(|&&c| triangles.binary_search(&(c / 3)).is_err());
                let outside: f64 = outside.map(|&c| angles[c as usize]).sum();
                Member {
                    group: g,
                    corners: Vec::new(),
                    full_angle: group.full_angle - FRAC_PI_2 * group.index - outside,
                    given: 0.0,
                    range: if may_change(g) { group.change } else { (now, now) },
                }
            })
            .collect();
        let mut free = Vec::new();
        for (i, &m) in member.iter().enumerate() {
            match members.get_mut(m as usize) {
                Some(member) => {
                    member.corners.push(i as u32);
                    member.given += given[i];
                }
                None => free.push(i as u32),
            }
        }
        let lack = given.chunks_exact(3).map(|a| PI - a.iter().sum::<f64>()).collect();
        let balances = self.balances(&members, change);
        Piece { corners, member, given, lack, members, free, balances }
    }

    fn balances(&self, members: &[Member], change: &[i32]) -> Vec<Balance> {
        let mut by_basin: Vec<(u32, u32)> = members
            .iter()
            .enumerate()
            .map(|(m, member)| (self.groups.list[member.group as usize].basin, m as u32))
            .filter(|&(basin, _)| !self.groups.basins[basin as usize].open)
            .collect();
        by_basin.sort_unstable();
        let of_basin = by_basin.chunk_by(|a, b| a.0 == b.0);
        of_basin
            .map(|pairs| {
                let members_here: Vec<u32> = pairs.iter().map(|&(_, m)| m).collect();
                let now = |&m: &u32| change[members[m as usize].group as usize];
                Balance { sum: members_here.iter().map(now).sum(), members: members_here }
            })
            .collect()
    }
}

impl Piece {
    /// What all its changes cost at the angles of the whole problem.
    pub(super) fn value(&self, norm: AngleNorm, angles: &[f64]) -> f64 {
        let pairs = self.corners.iter().zip(&self.given);
        pairs.map(|(&c, given)| norm.cost(angles[c as usize] - given)).sum()
    }

    /// Allowed changes of all members.
    pub(super) fn ranges(&self) -> Vec<(i32, i32)> {
        self.members.iter().map(|member| member.range).collect()
    }

    /// Number of members whose index may change.
    pub(super) fn n_open(&self) -> usize {
        self.members.iter().filter(|member| member.range.0 < member.range.1).count()
    }

    /// The changes of the members, from those of the whole problem.
    pub(super) fn changes(&self, change: &[i32]) -> Vec<i32> {
        self.members.iter().map(|member| change[member.group as usize]).collect()
    }

    /// The system of [`Self::solve`], or with rooms that of [`Self::relax`].
    pub(super) fn system(&self, with_rooms: bool) -> Result<System, NotPositiveDefinite> {
        let n = self.members.len();
        System::new(if with_rooms { rooms(&self.member, n) } else { self.member.clone() }, n)
    }

    /// The best angles at some changes of the indices.
    pub(super) fn solve(
        &self,
        norm: AngleNorm,
        system: &mut System,
        change: &[i32],
        watch: &mut Watch<'_, '_>,
    ) -> Result<Solved, ConsistencyError> {
        let members = self.members.iter().zip(change);
        let sums = members.map(|(member, &n)| member.sum(n)).collect();
        Program::new(&self.given, norm, sums).solve(system, watch)
    }

    /// The best angles at any real changes within ranges.
    pub(super) fn relax(
        &self,
        norm: AngleNorm,
        system: &mut System,
        ranges: &[(i32, i32)],
        watch: &mut Watch<'_, '_>,
    ) -> Result<Solved, ConsistencyError> {
        let members = self.members.iter().zip(ranges);
        let bounds: Vec<(f64, f64)> =
            members.map(|(member, range)| (member.sum(range.1), member.sum(range.0))).collect();
        Program::between(&self.given, norm, &bounds).solve(system, watch)
    }

    /// Narrows ranges to what the balances allow; false if they allow nothing.
    pub(super) fn balance(&self, ranges: &mut [(i32, i32)]) -> bool {
        self.balances.iter().all(|balance| balance.narrow(ranges))
    }
}

impl Balance {
    fn narrow(&self, ranges: &mut [(i32, i32)]) -> bool {
        loop {
            let low: i32 = self.members.iter().map(|&m| ranges[m as usize].0).sum();
            let high: i32 = self.members.iter().map(|&m| ranges[m as usize].1).sum();
            if low > self.sum || high < self.sum {
                return false;
            }
            // Each member can be as large as the sum leaves when all others are least, and the reverse.
            let mut is_narrower = false;
            for &m in &self.members {
                let range = &mut ranges[m as usize];
                let now = *range;
                range.1 = range.1.min(self.sum - low + now.0);
                range.0 = range.0.max(self.sum - high + now.1);
                is_narrower |= *range != now;
            }
            if !is_narrower {
                return true;
            }
        }
    }
}
