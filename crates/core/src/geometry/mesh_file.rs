//! Reader of the triangles in STL and OBJ files.

use super::mesh::Mesh;
use crate::spatial::Vec3;
use crate::text_file::read_bytes;
use std::path::Path;

/// Largest accepted size of a mesh file, bytes.
const LARGEST: usize = 256_000_000;

/// Length of a binary STL file without triangles, bytes.
const STL_HEAD: usize = 84;
/// Length of a triangle in a binary STL file, bytes.
const STL_TRIANGLE: usize = 50;

/// Reads the triangles of an STL or OBJ file, whose format is determined by the file extension, or returns
/// the reason why the file cannot be read.
pub(super) fn read_mesh(path: &Path) -> Result<Mesh, String> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !matches!(ending.as_str(), "stl" | "obj") {
        return Err("the file name must end in .stl or .obj; convert the mesh to STL or OBJ".to_owned());
    }
    let bytes = read_bytes(path, LARGEST).map_err(|error| error.to_string())?;
    let mesh = match ending.as_str() {
        "stl" if is_binary(&bytes) => binary_stl(&bytes),
        "stl" => ascii_stl(&String::from_utf8_lossy(&bytes))?,
        _ => obj(&String::from_utf8_lossy(&bytes))?,
    };
    if mesh.triangles.is_empty() {
        return Err("the file has no triangles; export the mesh again".to_owned());
    }
    if mesh.vertices.iter().any(|p| !p.norm().is_finite()) {
        return Err("a vertex coordinate is infinite, NaN or too large; export the mesh again".to_owned());
    }
    Ok(mesh)
}

fn is_binary(bytes: &[u8]) -> bool {
    bytes.get(80..STL_HEAD).is_some_and(|count| {
        let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
        count.checked_mul(STL_TRIANGLE).and_then(|size| size.checked_add(STL_HEAD)) == Some(bytes.len())
    })
}

fn binary_stl(bytes: &[u8]) -> Mesh {
    let mut mesh = Mesh::default();
    for triangle in bytes[STL_HEAD..].chunks_exact(STL_TRIANGLE) {
        // the first of the four vectors is the normal
        let number = |i: usize| {
            let at = 4 * i;
            f64::from(f32::from_le_bytes([
                triangle[at],
                triangle[at + 1],
                triangle[at + 2],
                triangle[at + 3],
            ]))
        };
        push(&mut mesh, [3, 6, 9].map(|i| Vec3::new(number(i), number(i + 1), number(i + 2))));
    }
    mesh
}

fn push(mesh: &mut Mesh, corners: [Vec3<f64>; 3]) {
    let first = mesh.vertices.len();
    mesh.vertices.extend(corners);
    mesh.triangles.push([first, first + 1, first + 2]);
}

/// Returns the three numbers after the keyword of a line, or an error message with the line number `number`.
fn vector(line: &str, number: usize) -> Result<Vec3<f64>, String> {
    let read = |text: &str| text.parse::<f64>().ok();
    let values: Vec<_> = line.split_whitespace().skip(1).take(3).filter_map(read).collect();
    match values[..] {
        [x, y, z] => Ok(Vec3::new(x, y, z)),
        _ => Err(format!("line {number} is '{}'; expected a vertex with three numbers", shortened(line))),
    }
}

fn shortened(line: &str) -> String {
    line.chars().take(60).collect()
}

fn ascii_stl(text: &str) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    let mut corners = Vec::with_capacity(3);
    for (index, line) in text.lines().enumerate() {
        match line.split_whitespace().next() {
            Some("vertex") => corners.push(vector(line.trim(), index + 1)?),
            Some("endloop") => {
                let [a, b, c] = corners[..] else {
                    return Err(format!(
                        "the loop that ends in line {} has {} instead of 3 vertices; export the mesh as triangles",
                        index + 1,
                        corners.len()
                    ));
                };
                push(&mut mesh, [a, b, c]);
                corners.clear();
            }
            _ => {}
        }
    }
    Ok(mesh)
}

fn obj(text: &str) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        match line.split_whitespace().next() {
            Some("v") => mesh.vertices.push(vector(line.trim(), number)?),
            Some("f") => {
                let corners =
                    line.split_whitespace().skip(1).map(|corner| vertex(corner, mesh.vertices.len()));
                let corners: Option<Vec<usize>> = corners.collect();
                let Some(corners) = corners.filter(|corners| corners.len() >= 3) else {
                    return Err(format!(
                        "line {number} is '{}'; expected a face with at least three indices of earlier vertices",
                        shortened(line)
                    ));
                };
                mesh.triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    Ok(mesh)
}

/// Returns the index, from 0, of the vertex in a corner such as `7/1/3`, where negative numbers count from
/// the last vertex; `None` if this is not one of the `count` vertices.
fn vertex(corner: &str, count: usize) -> Option<usize> {
    let index: i64 = corner.split('/').next()?.parse().ok()?;
    let index = if index < 0 { count as i64 + index } else { index - 1 };
    usize::try_from(index).ok().filter(|index| *index < count)
}
