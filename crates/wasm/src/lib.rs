//! Seamstress in a browser: tasks of the page, done in a worker.

use seamstress::{Context, Done, Task, refusal};
use std::cell::RefCell;
use std::ops::ControlFlow;
use wasm_bindgen::prelude::*;

thread_local! {
    /// Whom progress is told to; observers must not hold what belongs to one thread.
    static LISTENER: RefCell<Option<js_sys::Function>> = const { RefCell::new(None) };
}

/// The result of a task.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Outcome(Done);

#[wasm_bindgen]
impl Outcome {
    /// What its page says, as JSON.
    #[wasm_bindgen(getter)]
    pub fn facts(&self) -> String {
        self.0.page().facts()
    }

    /// What its page draws, packed.
    #[wasm_bindgen(getter)]
    pub fn scene(&self) -> Vec<u8> {
        self.0.page().scene().to_vec()
    }

    /// The result as a file of this name.
    ///
    /// # Errors
    /// If there is no such file of it.
    pub fn file(&self, name: &str) -> Result<Vec<u8>, String> {
        self.0.file(name).map_err(|error| refusal(&error))
    }
}

/// Does a task, described by JSON, with the content of a file; tells `listener` the stage, the component, the number of
/// components and the share of the stage that is done.
///
/// # Errors
/// The error as JSON.
#[wasm_bindgen]
pub fn run(
    task: &str,
    content: &[u8],
    name: &str,
    listener: js_sys::Function,
) -> Result<Outcome, String> {
    LISTENER.with(|place| place.replace(Some(listener)));
    let context = Context::new().observer(|progress| {
        let numbers = [progress.component as f64, progress.n_components as f64, progress.fraction];
        let [component, n_components, fraction] = numbers.map(JsValue::from);
        LISTENER.with_borrow(|listener| {
            let Some(listener) = listener else { return };
            let arguments = js_sys::Array::of4(
                &progress.stage.name().into(),
                &component,
                &n_components,
                &fraction,
            );
            // A listener that fails does not stop the work.
            let _ = listener.apply(&JsValue::NULL, &arguments);
        });
        ControlFlow::Continue(())
    });
    let done = Task::parse(task).and_then(|task| task.run(content, name, context));
    done.map(Outcome).map_err(|error| refusal(&error))
}
