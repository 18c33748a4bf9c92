//! Does a task of the page on this machine, to compare what browsers make of it: `task TASK.json MESH RESULT`.

use seamstress::{Context, Task};
use std::error::Error;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let [task, mesh, result] = env::args()
        .skip(1)
        .collect::<Vec<_>>()
        .try_into()
        .map_err(|_| "usage: task TASK.json MESH RESULT")?;
    let done = Task::parse(&fs::read_to_string(task)?)?;
    let done = done.run(&fs::read(&mesh)?, &mesh, Context::new())?;
    fs::write(&result, done.file(&result)?)?;
    Ok(())
}
