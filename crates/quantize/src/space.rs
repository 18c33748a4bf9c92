//! Layouts as exact functions of vertex positions and of what must be integral.

use crate::base::Base;
use crate::gauss::{Form, Gauss, Overflow, add_scaled};
use crate::isolines::{Levels, Tie, level, part, tied};
use crate::lattice::Lattice;
use crate::linear::{Row, apply};
use crate::walk::Walker;
use num_complex::Complex64;
use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh, VertexData};
use seamstress_parametrize::cut::{Cut, SeamGraph};
use seamstress_parametrize::layout::space::LinearSpace;
use seamstress_parametrize::quarter::{turn, unit};

/// What of a mesh has to come to lie on the grid.
#[derive(Debug, Clone)]
pub struct GridNeeds {
    /// The singular vertices, those whose index is a multiple of four included.
    pub is_cone: VertexData<bool>,
    /// The vertices that have to be grid points: the cones, and where aligned edges turn.
    pub is_point: VertexData<bool>,
    /// Half-edges of aligned edges, and the coordinate that their ends share: 0 for u, 1 for v.
    pub levels: Vec<(Halfedge, u32)>,
}

impl GridNeeds {
    /// Cones alone.
    pub fn cones(is_cone: VertexData<bool>) -> Self {
        Self { is_point: is_cone.clone(), is_cone, levels: Vec::new() }
    }
}

/// `z_wedge = i^turns x_vertex + form in X`, with X the translation of every chain of seams and the
/// position of every grid point, all of them integral in an integer-grid map; on an isoline one coordinate of
/// `x_vertex` is integral as well.
///
/// The *held* unknowns are the real and imaginary parts of X by turns, then the level of every isoline that
/// holds no grid point. They are integer forms in the *coordinates*, which are free.
#[derive(Debug, Clone)]
pub struct IntegerSpace {
    bases: Vec<Base>,
    forms: Vec<Form>,
    graph: SeamGraph,
    /// The coordinate of each ordinary vertex that an isoline ties, if one does.
    ties: Vec<Option<Tie>>,
    /// `X = B zeta` over the Gaussian integers.
    seams: Lattice,
    /// The parts of zeta and the levels of isolines, over the integers.
    isolines: Lattice,
    /// Every held unknown in the coordinates.
    held: Vec<Row>,
    chains: Vec<ChainEnds>,
    /// A wedge of each grid point.
    points: Vec<u32>,
    /// Where the level of each isoline without a grid point is read: wedge and coordinate.
    level_wedges: Vec<(u32, u32)>,
    origin: Origin,
}

/// The wedges on both sides of a chain's first vertex, and its matching.
#[derive(Debug, Clone, Copy)]
struct ChainEnds {
    left: u32,
    right: u32,
    matching: i32,
}

/// What a layout is translated by to meet the pin.
#[derive(Debug, Clone, Copy)]
enum Origin {
    Wedge(u32),
    Chain(ChainEnds),
}

impl IntegerSpace {
    /// The space over a cut and its matchings.
    ///
    /// Layouts may be translated. That freedom is used to hold something at zero: a grid point, without one
    /// the translation of a chain that turns, without such chains one vertex.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn new(
        mesh: &TriMesh,
        cut: &Cut,
        matching: &HalfedgeData<i32>,
        needs: &GridNeeds,
    ) -> Result<Self, Overflow> {
        let graph = SeamGraph::new(mesh, cut, &needs.is_cone);
        let ends = |&h: &Halfedge| {
            let [left, _, right, _] = cut.seam_wedges(mesh, h);
            ChainEnds { left, right, matching: matching[h] }
        };
        let chains: Vec<_> =
            graph.chains.iter().filter_map(|chain| chain.left.first().map(ends)).collect();
        let mut walker = Walker::new(mesh, cut, &graph, matching);
        let mut points = Vec::new();
        let mut n_ordinary = 0;
        for v in mesh.vertices() {
            let Some(first) = walker.start(v) else { continue };
            if needs.is_point[v] {
                let position = (chains.len() + points.len()) as u32;
                points.push(cut.wedge[first]);
                walker.walk(v, None, Form::from([(position, Gauss::ONE)]))?;
            } else {
                walker.walk(v, Some(n_ordinary), Form::new())?;
                n_ordinary += 1;
            }
        }
        let turning = chains.iter().position(|chain| chain.matching.rem_euclid(4) != 0);
        let (pinned, origin) = match (points.first(), turning) {
            (Some(&wedge), _) => (Some(chains.len() as u32), Origin::Wedge(wedge)),
            (None, Some(k)) => (Some(k as u32), Origin::Chain(chains[k])),
            (None, None) => (None, Origin::Wedge(walker.hold_last(&mut n_ordinary))),
        };
        let n_variables = chains.len() + points.len();
        let seams = Lattice::new(n_variables, &walker.relations, pinned)?;
        let Walker { bases, forms, .. } = walker;
        let edges: Vec<([u32; 2], u32)> =
            needs.levels.iter().map(|&(h, coordinate)| (cut.ends(h), coordinate)).collect();
        let Levels { ties, wedges: level_wedges, relations } =
            Levels::new(&bases, &forms, n_ordinary as usize, n_variables, &edges)?;
        let relations: Vec<Form> =
            relations.iter().map(|form| in_parts(&seams, form)).collect::<Result<_, Overflow>>()?;
        let isolines = Lattice::new(2 * seams.rank() + level_wedges.len(), &relations, None)?;
        let held = (0..(2 * n_variables + level_wedges.len()) as u32)
            .map(|k| {
                let parts = in_parts(&seams, &Form::from([(k, Gauss::ONE)]))?;
                Ok(real_row(&isolines.pull_back(&parts)?))
            })
            .collect::<Result<_, Overflow>>()?;
        Ok(Self {
            bases,
            forms,
            graph,
            ties,
            seams,
            isolines,
            held,
            chains,
            points,
            level_wedges,
            origin,
        })
    }

    /// Number of integral coordinates.
    pub fn n_coordinates(&self) -> usize {
        self.isolines.rank()
    }

    /// Number of held unknowns.
    pub fn n_held(&self) -> usize {
        self.held.len()
    }

    /// Number of unknowns that are free: the coordinates of the ordinary vertices but those tied.
    pub fn n_free(&self) -> usize {
        2 * self.ties.len() - self.ties.iter().flatten().count()
    }

    /// Number of wedges.
    pub fn n_wedges(&self) -> usize {
        self.bases.len()
    }

    /// The chains of seams that the variables X belong to.
    pub fn graph(&self) -> &SeamGraph {
        &self.graph
    }

    /// What moves a wedge besides the integral variables.
    pub fn base(&self, wedge: u32) -> Base {
        self.bases[wedge as usize]
    }

    /// The part of a wedge's position that the integral variables give.
    pub fn form(&self, wedge: u32) -> &Form {
        &self.forms[wedge as usize]
    }

    /// A coordinate of a wedge as a form in the held unknowns, if it is integral.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn level(&self, wedge: u32, coordinate: u32) -> Result<Option<Form>, Overflow> {
        level(self.base(wedge), self.form(wedge), &self.ties, coordinate)
    }

    /// The held unknowns as integer forms in the coordinates.
    pub fn held(&self) -> &[Row] {
        &self.held
    }

    /// A form in the held unknowns as one in the coordinates.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn row(&self, form: &Form) -> Result<Row, Overflow> {
        Ok(real_row(&self.isolines.pull_back(&in_parts(&self.seams, form)?)?))
    }

    /// Real and imaginary part of a form in X, in the coordinates.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn rows(&self, form: &Form) -> Result<[Row; 2], Overflow> {
        Ok([self.row(&part(form, 0))?, self.row(&part(form, 1))?])
    }

    /// The linear space with the free unknowns first, then the held ones.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn linear(&self) -> Result<LinearSpace, Overflow> {
        let free = self.free_unknowns();
        let first_held = self.n_free() as u32;
        let mut rows: Vec<Vec<(u32, f64)>> = Vec::with_capacity(2 * self.n_wedges());
        for wedge in 0..self.n_wedges() as u32 {
            for coordinate in [0, 1] {
                let mut row = Vec::new();
                let held = match (self.level(wedge, coordinate)?, self.base(wedge)) {
                    (None, Base::Ordinary { vertex, turns }) => {
                        let (of_x, sign) = tied(coordinate, turns);
                        let unknown = free[vertex as usize][of_x as usize];
                        row.extend(unknown.map(|k| (k, sign.re as f64)));
                        part(self.form(wedge), coordinate)
                    }
                    (level, _) => level.unwrap_or_default(),
                };
                row.extend(held.iter().map(|(&k, c)| (first_held + k, c.re as f64)));
                rows.push(row);
            }
        }
        let nodes = free.iter().enumerate();
        let nodes = nodes.flat_map(|(v, own)| own.iter().flatten().map(move |_| v as u32));
        let n_vertices = self.ties.len() as u32;
        let held_nodes = (0..self.n_held() as u32).map(|k| n_vertices + k / 2);
        Ok(LinearSpace::from_rows(nodes.chain(held_nodes).collect(), rows.into_iter()))
    }

    /// The free unknowns of each ordinary vertex: those of its coordinates, `None` for a tied one.
    fn free_unknowns(&self) -> Vec<[Option<u32>; 2]> {
        let mut n = 0;
        let mut next = |is_free: bool| {
            is_free.then(|| {
                n += 1;
                n - 1
            })
        };
        let unknowns = |tie: &Option<Tie>| {
            [0, 1].map(|c| next(tie.as_ref().is_none_or(|tie| tie.coordinate != c)))
        };
        self.ties.iter().map(unknowns).collect()
    }

    /// The coordinates of a layout, and its unknowns, the free ones and then the held ones, after
    /// translating it to meet the pin.
    ///
    /// Each is read at one place; what seams and isolines are off by shows at the others.
    pub fn read(&self, z: &[Complex64]) -> (Vec<f64>, Vec<f64>) {
        let at = |w: u32| z[w as usize];
        let translation =
            |c: &ChainEnds, by: Complex64| at(c.right) - by - turn(at(c.left) - by, c.matching);
        let origin = match self.origin {
            Origin::Wedge(w) => at(w),
            Origin::Chain(c) => {
                translation(&c, Complex64::ZERO) / (Complex64::ONE - unit(c.matching))
            }
        };
        let mut variables: Vec<Complex64> =
            self.chains.iter().map(|c| translation(c, origin)).collect();
        variables.extend(self.points.iter().map(|&w| at(w) - origin));
        let zeta = (0..self.seams.rank()).map(|k| evaluate(self.seams.coordinate(k), &variables));
        let mut parts: Vec<f64> = zeta.flat_map(|z| [z.re, z.im]).collect();
        for &(w, coordinate) in &self.level_wedges {
            let Base::Ordinary { turns, .. } = self.base(w) else { continue };
            let x = turn(at(w) - origin - evaluate(self.form(w), &variables), -turns);
            parts.push(if tied(coordinate, turns).0 == 0 { x.re } else { x.im });
        }
        let coordinate = |k: usize| {
            let form = self.isolines.coordinate(k);
            form.iter().map(|(&v, c)| c.re as f64 * parts[v as usize]).sum()
        };
        let coordinates: Vec<f64> = (0..self.n_coordinates()).map(coordinate).collect();
        let held = self.expand_real(&coordinates);
        let exact: Vec<Complex64> = self.variables(&held).collect();
        let free = self.free_unknowns();
        let mut y = vec![0.0; self.n_free()];
        for (w, base) in self.bases.iter().enumerate() {
            if let Base::Ordinary { vertex, turns } = *base {
                let moved = z[w] - origin - evaluate(&self.forms[w], &exact);
                let x = turn(moved, -turns);
                for (unknown, x) in free[vertex as usize].into_iter().zip([x.re, x.im]) {
                    if let Some(k) = unknown {
                        y[k as usize] = x;
                    }
                }
            }
        }
        y.extend(held);
        (coordinates, y)
    }

    /// Positions of the ordinary vertices for free and held unknowns.
    pub fn positions(&self, free: &[f64], held: &[f64]) -> Vec<Complex64> {
        let unknowns = self.free_unknowns();
        let position = |(tie, unknowns): (&Option<Tie>, [Option<u32>; 2])| {
            let level = || {
                let level = tie.iter().flat_map(|tie| &tie.level);
                level.map(|(&k, c)| c.re as f64 * held[k as usize]).sum::<f64>()
            };
            let [re, im] = unknowns.map(|k| k.map_or_else(level, |k| free[k as usize]));
            Complex64::new(re, im)
        };
        self.ties.iter().zip(unknowns).map(position).collect()
    }

    /// The variables X among held unknowns.
    fn variables<'a>(&self, held: &'a [f64]) -> impl Iterator<Item = Complex64> + 'a {
        let n = 2 * self.seams.n_variables();
        held[..n].chunks(2).map(|pair| Complex64::new(pair[0], pair[1]))
    }

    /// The held unknowns at real coordinates.
    pub fn expand_real(&self, coordinates: &[f64]) -> Vec<f64> {
        self.held.iter().map(|row| apply(row, coordinates)).collect()
    }

    /// The held unknowns at integers.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn expand(&self, coordinates: &[i64]) -> Result<Vec<i64>, Overflow> {
        let value = |row: &Row| {
            row.iter()
                .try_fold(0i64, |sum, &(k, c)| sum.checked_add(c.checked_mul(coordinates[k])?))
        };
        self.held.iter().map(|row| value(row).ok_or(Overflow)).collect()
    }
}

/// A form in the held unknowns as one in the parts of zeta and the levels of isolines.
fn in_parts(seams: &Lattice, form: &Form) -> Result<Form, Overflow> {
    let (n_held, n_parts) = (2 * seams.n_variables() as u32, 2 * seams.rank() as u32);
    let mut result = Form::new();
    for (&k, &c) in form {
        if k < n_held {
            let row = part(seams.row(k as usize / 2), k % 2);
            add_scaled(&mut result, &row, c)?;
        } else {
            add_scaled(&mut result, &Form::from([(n_parts + k - n_held, Gauss::ONE)]), c)?;
        }
    }
    Ok(result)
}

/// A real form as a row.
fn real_row(form: &Form) -> Row {
    form.iter().map(|(&k, c)| (k as usize, c.re)).collect()
}

/// The value of a form at complex variables.
pub fn evaluate(form: &Form, at: &[Complex64]) -> Complex64 {
    form.iter().map(|(&v, c)| c.to_complex() * at[v as usize]).sum()
}
