//! A cache changes no result: the database is the same with an empty, a full, an old and a damaged one.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use motiondb::motion::MotionDb;
use motiondb_compiler::{Cache, Compiled, Manifest, clip_files, compile_manifest, compile_with_cache};

const CLIPS: [&str; 7] = ["walk_110", "walk_180", "turn_060_left", "side_060_left", "backward_040", "idle", "run_350"];

/// A library of some bundled clips, one of them twice, and a folder for its cache.
struct Library {
    folder: tempfile::TempDir,
}

impl Library {
    fn new() -> Self {
        let library = Self { folder: tempfile::tempdir().unwrap() };
        fs::create_dir_all(library.clips().join("copies")).unwrap();
        CLIPS.iter().for_each(|clip| library.write(clip, &bundled(clip)));
        library.write("copies/walk_110", &bundled("walk_110"));
        library.write("copies/no_motion", "HIERARCHY\n");
        fs::copy(bundled_path("walk_140.glb"), library.clips().join("walk_140.glb")).unwrap();
        library
    }

    fn clips(&self) -> PathBuf {
        self.folder.path().join("clips")
    }

    fn cache(&self) -> PathBuf {
        self.folder.path().join("cache")
    }

    fn write(&self, clip: &str, text: &str) {
        fs::write(self.clips().join(format!("{clip}.bvh")), text).unwrap();
    }

    fn manifest(&self) -> Manifest {
        Manifest::of_files(&clip_files(&self.clips()).unwrap())
    }

    /// The database with the cache, which is that without it.
    #[track_caller]
    fn check(&self, manifest: &Manifest) -> MotionDb {
        let plain = compile_manifest(manifest, &|_| ()).unwrap();
        let cached = compile_with_cache(manifest, &Cache::open(&self.cache()).unwrap(), &|_| ()).unwrap();
        assert!(plain.db == cached.db, "{:?}\n{:?}", plain.db.sources, cached.db.sources);
        assert_eq!(plain.rejected, cached.rejected);
        plain.db
    }

    /// The files of the cache and the times at which they were written.
    fn entries(&self) -> Vec<(PathBuf, SystemTime)> {
        let entries = fs::read_dir(self.cache()).unwrap().map(|entry| entry.unwrap().path());
        let mut entries: Vec<_> = entries.map(|path| (path.clone(), written(&path))).collect();
        entries.sort();
        entries
    }
}

fn written(path: &Path) -> SystemTime {
    fs::metadata(path).unwrap().modified().unwrap()
}

fn bundled(clip: &str) -> String {
    fs::read_to_string(bundled_path(&format!("{clip}.bvh"))).unwrap()
}

fn bundled_path(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips").join(file)
}

/// The clip without its last frames.
fn shortened(clip: &str, frames: usize) -> String {
    let text = bundled(clip);
    let count: usize = text.lines().find_map(|line| line.strip_prefix("Frames:")).unwrap().trim().parse().unwrap();
    let lines = text.lines().map(|line| match line.strip_prefix("Frames:") {
        Some(_) => format!("Frames: {}", count - frames),
        None => line.to_owned(),
    });
    let kept = text.lines().count() - frames;
    lines.take(kept).collect::<Vec<String>>().join("\n") + "\n"
}

#[test]
fn a_full_cache_gives_the_same_database_and_is_not_written_again() {
    let library = Library::new();
    let first = library.check(&library.manifest());
    assert!(first.examples.len() > CLIPS.len(), "{:?}", first.sources);
    let entries = library.entries();
    // Eight files, nine analyses (a copy has another name), and the comparisons.
    assert_eq!(entries.len(), 8 + 9 + 1);
    library.check(&library.manifest());
    assert_eq!(library.entries(), entries);
}

#[test]
fn what_changes_is_computed_again() {
    let library = Library::new();
    library.check(&library.manifest());
    library.write("walk_180", &shortened("walk_180", 40));
    let changed = library.check(&library.manifest());
    library.write("new", &shortened("turn_060_left", 10));
    library.check(&library.manifest());
    fs::remove_file(library.clips().join("idle.bvh")).unwrap();
    library.check(&library.manifest());
    let mut manifest = library.manifest();
    let position = manifest.clips.iter().position(|clip| clip.path.ends_with("walk_180.bvh")).unwrap();
    manifest.clips[position].frames = Some([5, 65]);
    let cut = library.check(&manifest);
    assert!(cut != changed);
    manifest.clips[position].mirror = Some(true);
    manifest.clips[position].name = Some("idle walk".to_owned());
    library.check(&manifest);
}

#[test]
fn another_body_is_analysed_again() {
    let library = Library::new();
    let text = |name: &str| {
        let clips = ["walk_110", "idle"].map(|clip| format!("[[clips]]\npath = \"{clip}.bvh\"\n")).concat();
        let larger = "[[clips]]\npath = \"walk_180.bvh\"\nmetres_per_unit = 0.012\n";
        format!("target_skeleton = \"{name}\"\n{clips}{larger}")
    };
    let manifest = |name: &str| {
        let path = library.clips().join("manifest.toml");
        fs::write(&path, text(name)).unwrap();
        Manifest::read(&path).unwrap()
    };
    let small = library.check(&manifest("walk_110"));
    let large = library.check(&manifest("walk_180"));
    assert!(large.skeleton.offsets_m != small.skeleton.offsets_m);
    library.check(&manifest("walk_110"));
}

#[test]
fn damaged_results_are_computed_again() {
    let library = Library::new();
    library.check(&library.manifest());
    let damages: [fn(&mut Vec<u8>); 4] = [
        |bytes| bytes.truncate(bytes.len() / 2),
        |bytes| bytes.clear(),
        |bytes| *bytes.last_mut().unwrap() ^= 1,
        |bytes| bytes[8] += 1,
    ];
    for damage in damages {
        for (entry, _) in library.entries() {
            let mut bytes = fs::read(&entry).unwrap();
            damage(&mut bytes);
            fs::write(&entry, bytes).unwrap();
        }
        library.check(&library.manifest());
    }
    // Each second result is that of another key, or a folder.
    for (index, (entry, _)) in library.entries().into_iter().enumerate().step_by(2) {
        let other = library.entries()[(index + 1) % 18].0.clone();
        fs::remove_file(&entry).unwrap();
        if index % 4 == 0 { fs::copy(other, &entry).map(drop) } else { fs::create_dir(&entry) }.unwrap();
    }
    library.check(&library.manifest());
}

#[test]
fn two_compilations_may_share_a_cache() {
    let library = Library::new();
    let (manifest, cache) = (library.manifest(), library.cache());
    let compiled = || compile_with_cache(&manifest, &Cache::open(&cache).unwrap(), &|_| ()).unwrap();
    let all: Vec<Compiled> = std::thread::scope(|scope| {
        let threads = [(); 4].map(|()| scope.spawn(compiled));
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    let plain = library.check(&manifest);
    assert!(all.iter().all(|compiled| compiled.db == plain));
    assert!(library.entries().iter().all(|(path, _)| path.extension().is_some_and(|end| end == "fbcache")));
}
