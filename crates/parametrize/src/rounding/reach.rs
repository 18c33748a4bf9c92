//! The sectors around a cone, by distance along roads.

use crate::features::{Road, Sectors};
use crate::ordered::Ordered;
use seamstress_mesh::{Metric, Vertex, VertexData};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A search for the sectors around others, with memory that it uses again.
pub(super) struct BallSearch<'a> {
    sectors: &'a Sectors<'a>,
    metric: &'a Metric,
    area: VertexData<f64>,
    /// Area of a ball.
    reach: f64,
    /// Distance of each sector, and the way to it: infinite and none between searches.
    nearest: VertexData<(f64, Option<(u32, Road)>)>,
}

const FAR: (f64, Option<(u32, Road)>) = (f64::INFINITY, None);

/// The sectors that a cone may go to: a ball of some area.
pub(super) struct Ball {
    /// From the middle outwards.
    pub(super) sectors: Vec<Vertex>,
    /// The way to each: the place of the sector before it, and the road from there. None for the middle.
    roads: Vec<Option<(u32, Road)>>,
}

impl<'a> BallSearch<'a> {
    /// For balls with a part of the whole area.
    pub(super) fn new(sectors: &'a Sectors<'a>, metric: &'a Metric, part: f64) -> Self {
        let area = metric.vertex_area(sectors.slit());
        let reach = part * area.iter().sum::<f64>();
        let nearest = VertexData::filled(area.len(), FAR);
        Self { sectors, metric, area, reach, nearest }
    }

    /// The sectors nearest to one, until their area is reached.
    pub(super) fn around(&mut self, middle: Vertex) -> Ball {
        let mut ball = Ball { sectors: Vec::new(), roads: Vec::new() };
        let nearest = &mut self.nearest;
        nearest[middle].0 = 0.0;
        let mut queue = BinaryHeap::from([Reverse((Ordered(0.0), middle))]);
        let mut seen = vec![middle];
        let mut covered = 0.0;
        while let Some(Reverse((Ordered(distance), s))) = queue.pop() {
            let (least, road) = nearest[s];
            if distance > least {
                continue;
            }
            let place = ball.sectors.len() as u32;
            ball.sectors.push(s);
            ball.roads.push(road);
            covered += self.area[s];
            if covered > self.reach {
                break;
            }
            for road in self.sectors.roads(s) {
                let distance = distance + self.metric.length[road.halfedge];
                if distance < nearest[road.to].0 {
                    nearest[road.to] = (distance, Some((place, road)));
                    queue.push(Reverse((Ordered(distance), road.to)));
                    seen.push(road.to);
                }
            }
        }
        seen.into_iter().for_each(|s| nearest[s] = FAR);
        ball
    }
}

impl Ball {
    /// Sums over the roads from the middle to each place.
    pub(super) fn sums(&self, of: impl Fn(Road) -> f64) -> Vec<f64> {
        let mut sums = Vec::with_capacity(self.roads.len());
        for road in &self.roads {
            sums.push(road.map_or(0.0, |(before, road)| sums[before as usize] + of(road)));
        }
        sums
    }

    /// The roads from a place back to the middle.
    pub(super) fn way_back(&self, mut place: usize) -> impl Iterator<Item = Road> + '_ {
        std::iter::from_fn(move || {
            let (before, road) = self.roads[place]?;
            place = before as usize;
            Some(road)
        })
    }
}
