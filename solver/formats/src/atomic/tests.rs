use std::collections::BTreeMap;

use super::folder::Step;
use super::*;

const STEPS: [Step; 6] = [
    Step::Mark,
    Step::SyncNew,
    Step::SetOldAside,
    Step::PutNewInPlace,
    Step::SyncParent,
    Step::RemoveOld,
];

fn write(target: &Path, text: &str) {
    let folder = Folder::begin(target).unwrap();
    fill(&folder, text);
    folder.commit().unwrap();
}

fn fill(folder: &Folder, text: &str) {
    fs::create_dir_all(folder.path().join("below")).unwrap();
    fs::write(folder.path().join("a"), text).unwrap();
    fs::write(folder.path().join("below/b"), text).unwrap();
}

/// Every file but the mark with its content.
fn content(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let files = mark::files_below(folder).unwrap_or_default();
    files.into_iter().map(|f| (f.clone(), fs::read(folder.join(f)).unwrap())).collect()
}

#[test]
fn an_abandoned_folder_never_appears_and_a_committed_one_replaces() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("maps");
    let abandoned = Folder::begin(&target).unwrap();
    fs::write(abandoned.path().join("half"), "x").unwrap();
    assert!(!target.exists());
    let second = Folder::begin(&target).unwrap();
    assert!(!second.path().join("half").exists(), "leftovers of the first attempt are gone");
    second.commit().unwrap();
    write(&target, "new");
    assert_eq!(content(&target).len(), 2);
    let left: Vec<_> = fs::read_dir(root.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

#[test]
fn a_cut_at_any_step_leaves_the_old_or_the_new_folder_whole() {
    for step in STEPS {
        for old in [None, Some("old")] {
            let root = tempfile::tempdir().unwrap();
            let target = root.path().join("maps");
            old.into_iter().for_each(|text| write(&target, text));
            let before = content(&target);
            let folder = Folder::begin(&target).unwrap();
            fill(&folder, "new");
            let after = content(folder.path());
            let cut = |at| if at == step { Err(io::Error::other("cut")) } else { Ok(()) };
            folder.commit_by_steps(cut).unwrap_err();
            let whole = [&target, &with_suffix(&target, ".replaced")]
                .map(|place| content(place))
                .into_iter()
                .any(|found| found == before || found == after);
            assert!(whole, "{step:?} {old:?}");
            // The next attempt puts all in order, keeps what was whole, and then replaces it.
            let next = Folder::begin(&target).unwrap();
            let found = content(&target);
            assert!(found == before || found == after, "{step:?} {old:?}");
            assert!(!with_suffix(&target, ".replaced").exists(), "{step:?} {old:?}");
            fill(&next, "newer");
            next.commit().unwrap();
            assert_eq!(content(&target)[Path::new("a")], b"newer");
            assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
        }
    }
}

#[test]
fn what_is_not_ours_is_never_replaced() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("maps");
    fs::create_dir(&target).unwrap();
    fs::write(target.join("thesis.tex"), "years").unwrap();
    let error = Folder::begin(&target).unwrap_err().to_string();
    assert!(error.contains("not written by unshade") && error.contains("choose"), "{error}");
    // A file in its place, or in that of the partial folder or of the replaced one.
    for name in ["file", "other.partial", "third.replaced"] {
        fs::write(root.path().join(name), "mine").unwrap();
        let target = root.path().join(name.split('.').next().unwrap());
        assert!(Folder::begin(&target).is_err(), "{name}");
        assert_eq!(fs::read(root.path().join(name)).unwrap(), b"mine");
    }
    fs::create_dir(root.path().join("fourth.partial")).unwrap();
    fs::write(root.path().join("fourth.partial/x"), "mine").unwrap();
    assert!(Folder::begin(&root.path().join("fourth")).is_err());
    assert_eq!(fs::read(target.join("thesis.tex")).unwrap(), b"years");
}

#[test]
fn a_file_put_into_a_folder_of_ours_keeps_it() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("maps");
    write(&target, "old");
    let late = Folder::begin(&target).unwrap();
    fs::write(target.join("below/notes.txt"), "mine").unwrap();
    for error in [Folder::begin(&target).unwrap_err(), late.commit().unwrap_err()] {
        assert!(error.to_string().contains("below/notes.txt"), "{error}");
    }
    assert_eq!(content(&target).len(), 3);
    fs::remove_file(target.join("below/notes.txt")).unwrap();
    write(&target, "new");
}

#[test]
fn the_current_folder_and_those_above_are_refused() {
    let here = std::env::current_dir().unwrap();
    for target in [Path::new("."), Path::new(".."), &here, Path::new("src/.."), Path::new("/")] {
        let error = Folder::begin(target).unwrap_err();
        assert!(matches!(error, FolderError::Current(_)), "{target:?} {error}");
    }
}

#[test]
fn an_attempt_with_the_same_key_is_taken_up() {
    let root = tempfile::tempdir().unwrap();
    let target = root.path().join("capture");
    let kept = |key| {
        let folder = Folder::resume(&target, key).unwrap();
        let kept = folder.path().join("a").exists();
        fill(&folder, key);
        kept
    };
    assert_eq!(["k", "k", "other", "other", ""].map(kept), [false, true, false, true, false]);
}

#[test]
fn an_output_over_an_input_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let capture = root.path().join("capture");
    fs::create_dir_all(capture.join("truth")).unwrap();
    std::os::unix::fs::symlink(&capture, root.path().join("link")).unwrap();
    for (out, relation) in [
        (capture.clone(), "is the same as"),
        (root.path().join("link"), "is the same as"),
        (root.path().to_path_buf(), "contains"),
        (capture.join("maps/new"), "is inside"),
        (root.path().join("link/truth/../x"), "is inside"),
    ] {
        let error =
            refuse_overlap(&out, &[Path::new("elsewhere"), &capture]).unwrap_err().to_string();
        assert!(error.contains(&format!("{relation} the input")), "{error}");
    }
    refuse_overlap(&root.path().join("capture2"), &[&capture]).unwrap();
}

#[test]
fn a_link_stays_and_its_folder_is_replaced() {
    let root = tempfile::tempdir().unwrap();
    let (real, link) = (root.path().join("real"), root.path().join("link"));
    write(&real, "old");
    std::os::unix::fs::symlink(&real, &link).unwrap();
    write(&link, "new");
    assert!(link.is_symlink());
    assert_eq!(content(&real)[Path::new("a")], b"new");
}

#[test]
fn a_run_is_claimed_once_and_only_where_nothing_is() {
    let root = tempfile::tempdir().unwrap();
    let run = root.path().join("run");
    claim(&run).unwrap();
    fs::write(run.join("run.json"), "{}").unwrap();
    claim(&run).unwrap();
    assert!(Folder::begin(&run).is_err(), "a run is not replaced by maps");
    assert!(claim(root.path()).is_err() && claimable(root.path()).is_err());
    claimable(&run).unwrap();
    claimable(&root.path().join("another")).unwrap();
    assert!(!root.path().join("another").exists());
}

#[test]
fn what_does_not_fit_is_refused_beforehand() {
    let root = tempfile::tempdir().unwrap();
    require_space(&root.path().join("not/yet/there"), 1).unwrap();
    let error = require_space(root.path(), u64::MAX).unwrap_err().to_string();
    assert!(error.contains("make room"), "{error}");
}
